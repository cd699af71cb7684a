"""Show the bytes of an exchange as text."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.report import Exchange, Report, Result
from cobotwire.protocol.printable import printable


def shown(report: Report, exchange: Exchange) -> str:
    """Return the bytes in hex, or as the JSON text that a codec under test reads and writes."""
    if report.kind == "codec":
        return exchange.data.decode("utf-8", "replace").rstrip("\n")
    return exchange.data.hex(" ").upper()


def evidence_lines(report: Report, result: Result) -> Iterator[str]:
    """Yield a line for each exchange: seconds, direction, bytes, note."""
    for exchange in result.evidence:
        note = f"   {printable(exchange.note)}" if exchange.note else ""
        text = printable(shown(report, exchange))
        yield f"{exchange.at:10.4f} {exchange.direction:8} {text}{note}"
