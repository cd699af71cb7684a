"""Write reports as versioned JSON, and read them."""

from __future__ import annotations

import json
from dataclasses import asdict, fields
from math import isfinite
from typing import Any

from cobotwire.conformance.report import Cause, Environment, Exchange, Report, Result, Verdict
from cobotwire.protocol.errors import UsageError

FORMAT = "cobotwire-conformance"
# Counts up when a reader of the old version could misread the new one.
VERSION = 3
PLAIN = {
    "kind": str,
    "edition": str,
    "subject": str,
    "firmware": str,
    "started": str,
    "finished": bool,
    "reply_seconds": dict,
    "deadline_seconds": dict,
    "stopped": str,
    "untested": str,
    "options": dict,
    "statement": str,
    "catalogue": str,
    "edition_digest": str,
    "code_digest": str,
}


def to_json(report: Report) -> str:
    """Return a report as JSON text; bytes are hex, times are seconds."""
    data = {
        "format": FORMAT,
        "version": VERSION,
        "conforms": report.conforms,
        **{name: getattr(report, name) for name in PLAIN},
        "seconds": round(report.seconds, 3),
        "environment": asdict(report.environment),
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
            given = f"{data['format']}, version {data['version']}"
            message = f"the report is in the format {given}; needed: {FORMAT}, version {VERSION}"
            raise UsageError("report", given, message=message)
        results = [_read_result(item) for item in data["results"]]
        plain = {name: _checked(data[name], kind) for name, kind in PLAIN.items()}
        plain["reply_seconds"] = {
            command: [_seconds(each) for each in seconds]
            for command, seconds in plain["reply_seconds"].items()
        }
        plain["deadline_seconds"] = {
            command: _seconds(each) for command, each in plain["deadline_seconds"].items()
        }
        for name, text in plain["options"].items():
            plain["options"][name] = _checked(text, str)
        plain["seconds"] = _seconds(data["seconds"])
        return Report(**plain, environment=_environment(data["environment"]), results=results)
    except (ArithmeticError, LookupError, RecursionError, TypeError, ValueError) as error:
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
        "further": list(result.further),
        "group": result.group,
        "evidence": [
            {"at": round(e.at, 6), "direction": e.direction, "data": e.data.hex(), "note": e.note}
            for e in result.evidence
        ],
    }


def _environment(data: Any) -> Environment:
    names = [each.name for each in fields(Environment)]
    return Environment(**{name: _checked(data[name], str) for name in names})


def _read_result(item: dict[str, Any]) -> Result:
    evidence = tuple(
        Exchange(
            _seconds(e["at"]),
            _checked(e["direction"], str),
            bytes.fromhex(e["data"]),
            _checked(e["note"], str),
        )
        for e in item["evidence"]
    )
    verdict, cause = Verdict(item["verdict"]), Cause(item["cause"])
    names = ("case", "command", "reason", "source")
    case, command, reason, source = (_checked(item[name], str) for name in names)
    further = tuple(_checked(each, str) for each in _checked(item["further"], list))
    group = _checked(item["group"], str)
    return Result(case, command, verdict, reason, evidence, source, cause, further, group)


def _seconds(value: Any) -> float:
    """Return a finite number; raise an exception for anything else."""
    seconds = float(_checked(value, int | float))
    if not isfinite(seconds):
        raise ValueError(f"{seconds} is not a time")
    return seconds


def _checked(value: Any, kind: Any) -> Any:
    """Return a value if it is of its kind; raise a TypeError otherwise."""
    if not isinstance(value, kind):
        raise TypeError(f"{str(value)[:60]!r} has the wrong type")
    return value
