"""Write reports as versioned JSON, and read them."""

from __future__ import annotations

import json
from typing import Any

from cobotwire.conformance.report import Cause, Exchange, Report, Result, Verdict
from cobotwire.protocol.errors import UsageError

FORMAT = "cobotwire-conformance"
# Counts up when a reader of the old version could misread the new one.
VERSION = 2
PLAIN = (
    "kind",
    "edition",
    "subject",
    "firmware",
    "started",
    "finished",
    "reply_seconds",
    "deadline_seconds",
)


def to_json(report: Report) -> str:
    """Return a report as JSON text; bytes are hex, times are seconds."""
    data = {
        "format": FORMAT,
        "version": VERSION,
        "conforms": report.conforms,
        **{name: getattr(report, name) for name in PLAIN},
        "results": [_result(result) for result in report.results],
    }
    return json.dumps(data, indent=1) + "\n"


def from_json(text: str) -> Report:
    """Return the report that a JSON text holds.

    Raises:
        UsageError: the text is not a report, or is one of another version.
    """
    try:
        data = json.loads(text)
        if data["format"] != FORMAT or data["version"] != VERSION:
            given = (data["format"], data["version"])
            raise UsageError("report", given, f"{FORMAT}, version {VERSION}")
        results = [_read_result(item) for item in data["results"]]
        return Report(**{name: data[name] for name in PLAIN}, results=results)
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, UsageError):
            raise
        raise UsageError("report", message=f"this is not a report in JSON: {error!r}") from error


def _result(result: Result) -> dict[str, Any]:
    return {
        "case": result.case,
        "command": result.command,
        "verdict": result.verdict.value,
        "cause": result.cause.value,
        "reason": result.reason,
        "source": result.source,
        "evidence": [
            {"at": round(e.at, 6), "direction": e.direction, "data": e.data.hex(), "note": e.note}
            for e in result.evidence
        ],
    }


def _read_result(item: dict[str, Any]) -> Result:
    evidence = tuple(
        Exchange(e["at"], e["direction"], bytes.fromhex(e["data"]), e["note"])
        for e in item["evidence"]
    )
    verdict, cause = Verdict(item["verdict"]), Cause(item["cause"])
    case, command, reason = item["case"], item["command"], item["reason"]
    return Result(case, command, verdict, reason, evidence, item["source"], cause)
