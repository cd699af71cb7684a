"""Reports as versioned JSON, and back."""

from __future__ import annotations

import json
from typing import Any

from cobotwire.conformance.report import Exchange, Report, Result, Verdict
from cobotwire.errors import UsageError

FORMAT = "cobotwire-conformance"
# Counts up when a reader of the old form could misread the new one.
VERSION = 1


def to_json(report: Report) -> str:
    """A report as JSON text; bytes are hex, times are seconds."""
    data = {
        "format": FORMAT,
        "version": VERSION,
        "kind": report.kind,
        "edition": report.edition,
        "subject": report.subject,
        "firmware": report.firmware,
        "began": report.began,
        "finished": report.finished,
        "conforms": report.conforms,
        "results": [_result(result) for result in report.results],
        "reply_seconds": report.reply_seconds,
        "deadline_seconds": report.deadline_seconds,
    }
    return json.dumps(data, indent=1) + "\n"


def from_json(text: str) -> Report:
    """The report of a JSON text.

    Raises:
        UsageError: it is no such report, or one of a later version.
    """
    try:
        data = json.loads(text)
        if data["format"] != FORMAT or data["version"] != VERSION:
            given = (data["format"], data["version"])
            raise UsageError("report", given, f"{FORMAT}, version {VERSION}")
        return _report(data)
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, UsageError):
            raise
        raise UsageError("report", text[:40], f"a report in JSON ({error!r})") from error


def _report(data: dict[str, Any]) -> Report:
    return Report(
        kind=data["kind"],
        edition=data["edition"],
        subject=data["subject"],
        began=data["began"],
        firmware=data["firmware"],
        finished=data["finished"],
        results=[_read_result(item) for item in data["results"]],
        reply_seconds=data["reply_seconds"],
        deadline_seconds=data["deadline_seconds"],
    )


def _result(result: Result) -> dict[str, Any]:
    return {
        "rule": result.rule,
        "command": result.command,
        "verdict": result.verdict.value,
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
    verdict = Verdict(item["verdict"])
    rule, command = item["rule"], item["command"]
    return Result(rule, command, verdict, item["reason"], evidence, item["source"])
