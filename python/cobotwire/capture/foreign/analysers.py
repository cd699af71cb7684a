"""Read the bytes that logic analysers decoded: Saleae Logic 1 and 2, PulseView and sigrok-cli."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator

from cobotwire.capture.foreign.reader import (
    Chunk,
    ForeignFile,
    Line,
    Reader,
    seconds_ns,
    starts_with,
)
from cobotwire.capture.packet import Direction
from cobotwire.protocol.counted import counted

_HEX = re.compile(r"0x([0-9a-f]{2})", re.IGNORECASE)


def _saleae(file: ForeignFile) -> Iterator[Chunk]:
    """Yield the rows of the table that Logic exports for an "Async Serial" analyser.

    Logic 1 (``SerialAnalyzerResults.cpp`` of its SDK) has the columns ``Time [s]``, ``Value``,
    ``Parity Error`` and ``Framing Error``; Logic 2 has ``name``, ``type``, ``start_time``,
    ``duration``, ``data`` and perhaps ``error``. Saleae's manual states the units.
    """
    lines = file.lines()
    head = next(lines, Line(1, ""))
    columns = [name.strip().lower().removeprefix("\xef\xbb\xbf") for name in _fields(file, head)]
    of = {name: at for at, name in enumerate(columns)}
    time, value = of.get("start_time", of.get("time [s]")), of.get("data", of.get("value"))
    if time is None or value is None:
        file.reject(head, "the columns of an 'Async Serial' export by Saleae Logic")
    errors = [at for name, at in of.items() if name.endswith("error")]
    damaged = 0
    for line in lines:
        row = _fields(file, line)
        # A row may lack its last column, if that is empty.
        row += [""] * (len(columns) - len(row))
        if "type" in of and row[of["type"]] != "data":
            file.reject(line, "a row of type data: an export of an 'Async Serial' analyser only")
        if not (found := _HEX.fullmatch(row[value].strip())):
            file.reject(
                line, "a byte such as 0xFE: show the data as hex in Logic, and export again"
            )
        if (time_ns := seconds_ns(row[time].strip())) is None:
            file.reject(line, "a time in seconds, without ISO 8601 timestamps")
        damaged += any(row[at].strip().lower() not in ("", "false") for at in errors)
        name = row[of["name"]] if "name" in of else ""
        direction = _direction(name)
        stream = name if direction == "unknown" else ""
        yield Chunk(bytes.fromhex(found[1]), direction, time_ns, stream)
    if damaged:
        file.notes.append(f"{counted(damaged, 'byte')} had a parity or framing error on the wire")


def _fields(file: ForeignFile, line: Line) -> list[str]:
    try:
        return next(csv.reader([line.text]), [""])
    except csv.Error:
        file.reject(line, "a row of a CSV file")


def _direction(name: str) -> Direction:
    """Return the direction that the name of a channel means: TX is what the host sends."""
    words = re.findall("[a-z]+", name.lower())
    return "sent" if "tx" in words else "received" if "rx" in words else "unknown"


_SIGROK = re.compile(
    r"(?:[0-9]+-[0-9]+ )?(uart(?:-[0-9]+)?): (?:([RT]X) ([a-z ]+): )?(.+)", re.IGNORECASE
)
_NOT_DATA = re.compile(r"[01]|(?:Start|Stop|Parity) bit.*", re.IGNORECASE)
_PROBLEM = re.compile(r"(?:Frame|Parity) error|Break( condition)?", re.IGNORECASE)


def _sigrok(file: ForeignFile) -> Iterator[Chunk]:
    """Yield the data of annotations of the UART decoder, as PulseView and sigrok-cli export them.

    PulseView writes ``109-179 UART: RX data: FE``, by its setting ``%s %d: %c: %1``
    (``decodetrace.cpp``); sigrok-cli writes ``109-179 uart-1: FE`` or ``uart-1: FE``. The numbers
    of samples are not times: the file does not state their rate.
    """
    problems = 0
    for line in file.lines():
        found = _SIGROK.fullmatch(line.text)
        text = found[4] if found else ""
        kind = found[3] if found else None
        if found and (kind or "data").lower() == "data" and re.fullmatch("[0-9a-fA-F]{2}", text):
            yield Chunk(bytes.fromhex(text), _direction(found[2] or ""), None, found[1])
        elif found and _PROBLEM.fullmatch(text):
            problems += 1
        elif not (found and ((kind or "data").lower() != "data" or _NOT_DATA.fullmatch(text))):
            file.reject(line, "an annotation such as 'UART: RX data: FE' (data format hex)")
    if problems:
        file.notes.append(f"the UART decoder reported {counted(problems, 'error')}")


READERS = (
    Reader(
        "saleae",
        "a table of Saleae Logic",
        starts_with(
            rb'"?(?:Time \[s\]"?,"?Value\b|name"?,"?type"?,"?start_time"?,"?duration"?,"?data\b)'
        ),
        _saleae,
        remark="its times have no date: they count from the start of the measurement",
    ),
    Reader(
        "sigrok",
        "annotations of sigrok",
        starts_with(rb"(?:[0-9]+-[0-9]+ )?uart(?:-[0-9]+)?: "),
        _sigrok,
    ),
)
