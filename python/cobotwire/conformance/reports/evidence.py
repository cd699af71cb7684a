"""What went over the line, as text."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.report import Exchange, Report, Result


def said(report: Report, exchange: Exchange) -> str:
    """The bytes of an exchange: in hex, or as the text that a codec under test speaks."""
    if report.kind == "codec":
        return exchange.data.decode("utf-8", "replace").rstrip("\n")
    return exchange.data.hex(" ").upper()


def lines_of(report: Report, result: Result) -> Iterator[str]:
    """The evidence, a line an exchange: seconds, direction, bytes, note."""
    for exchange in result.evidence:
        note = f"   {exchange.note}" if exchange.note else ""
        text = said(report, exchange)
        yield f"{exchange.at:10.4f} {exchange.direction:5} {text}{note}"
