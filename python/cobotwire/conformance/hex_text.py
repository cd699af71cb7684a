"""Show bytes, and the exchanges of a report, as text."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.report import Exchange, Kind, Result
from cobotwire.protocol.printable import printable


def shown(data: bytes, most: int = 40) -> str:
    """Return bytes as hex, shortened if they are many."""
    text = data[:most].hex(" ").upper()
    return text if len(data) <= most else f"{text} ... ({len(data)} bytes)"


def exchanged(kind: Kind, exchange: Exchange) -> str:
    """Return the bytes in hex, or as the JSON text that a codec under test reads and writes."""
    if kind == "codec":
        return exchange.data.decode("utf-8", "replace").rstrip("\n")
    return exchange.data.hex(" ").upper()


def evidence_lines(kind: Kind, result: Result) -> Iterator[str]:
    """Yield a line for each further failure, then for each exchange: time, bytes, note."""
    for also in result.further:
        yield f"also, {printable(also)}"
    for exchange in result.evidence:
        note = f"   {printable(exchange.note)}" if exchange.note else ""
        text = printable(exchanged(kind, exchange))
        yield f"{exchange.at:10.4f} {exchange.direction:8} {text}{note}"
