"""Write reports as versioned JSON, and read them."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from enum import StrEnum
from math import isfinite
from typing import Any, Literal, get_args, get_origin, get_type_hints

from cobotwire.conformance.report import Environment, Exchange, Host, Report, Result
from cobotwire.inspect.seal import Signer, digest_of, sealed
from cobotwire.protocol.errors import UsageError

FORMAT = "cobotwire-conformance"
# Counts up when a reader of the old version could misread the new one.
VERSION = 4
WRONG = (ArithmeticError, LookupError, RecursionError, TypeError, ValueError)
RECORDS = (Report, Result, Environment, Host, Exchange)


def to_json(report: Report, sign: Signer | None = None) -> str:
    """Return a report as JSON text, sealed; bytes are hex, times are seconds."""
    return json.dumps(sealed(_document(report), sign), indent=1) + "\n"


def report_digest(report: Report) -> str:
    """Return the digest that the report in JSON has."""
    return digest_of(_document(report))


def _document(report: Report) -> dict[str, Any]:
    head = {"format": FORMAT, "version": VERSION, "conforms": report.conforms}
    return {**head, **_plain(report), "seconds": round(report.seconds, 3)}


def from_json(text: str) -> Report:
    """Return the report that a JSON text holds.

    Raises:
        UsageError: the text is not a report, or is one of another version, or was changed after it
            was written. A report without a digest is read as it is.
    """
    data = document_of(text)
    try:
        report: Report = _read(Report, data)
        if "digest" in data and data["digest"] != digest_of(data):
            message = (
                "the report was changed after it was written: its digest is not that of its "
                "contents (`conform verify`); to use it all the same, remove the key digest"
            )
            raise UsageError("report", message=message)
        return report
    except WRONG as error:
        raise _unreadable(error) from error


def document_of(text: str) -> dict[str, Any]:
    """Return the JSON object of a report; only its format and version are checked.

    Raises:
        UsageError: the text is not JSON, or is of another format or version.
    """
    try:
        data: dict[str, Any] = _checked(json.loads(text), dict)
        if data["format"] != FORMAT or data["version"] != VERSION:
            found = f"{data['format']}, version {data['version']}"
            message = f"the report is in the format {found}; needed: {FORMAT}, version {VERSION}"
            raise UsageError("report", found, message=message)
        return data
    except WRONG as error:
        raise _unreadable(error) from error


def _unreadable(error: Exception) -> UsageError:
    if isinstance(error, UsageError):
        return error
    return UsageError("report", message=f"this is not a report in JSON: {error!r}")


def _plain(value: Any) -> Any:
    """Return a record, or a value in one, as JSON values."""
    if isinstance(value, Exchange):
        return {**value._asdict(), "at": round(value.at, 6), "data": value.data.hex()}
    if is_dataclass(value):
        return {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
    return [_plain(each) for each in value] if isinstance(value, list | tuple) else value


def _read(kind: Any, value: Any) -> Any:
    """Return a JSON value as a value of a type, checked in all its parts.

    Raises:
        LookupError, TypeError, ValueError: the value is not of that type.
    """
    outer, inner = get_origin(kind), get_args(kind)
    if kind in RECORDS:
        hints = get_type_hints(kind)
        return kind(**{name: _read(hint, value[name]) for name, hint in hints.items()})
    if outer in (list, tuple):
        return outer(_read(inner[0], each) for each in _checked(value, list))
    if outer is dict:
        return {name: _read(inner[1], each) for name, each in _checked(value, dict).items()}
    if kind is float:
        seconds = float(_checked(value, int | float))
        if not isfinite(seconds):
            raise ValueError(f"{seconds} is not a time")
        return seconds
    if kind is bytes:
        return bytes.fromhex(value)
    if outer is None and issubclass(kind, StrEnum):
        return kind(value)
    return _checked(value, str if outer is Literal else kind)


def _checked(value: Any, kind: Any) -> Any:
    """Return a value if it is of its kind; raise a TypeError otherwise."""
    if not isinstance(value, kind):
        raise TypeError(f"{str(value)[:60]!r} has the wrong type")
    return value
