"""Frames and findings as ``cobotwire decode`` shows them: on a line, byte by byte, or as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import click

from cobotwire.cli.call import plain
from cobotwire.codec.interface import Codec, Frame
from cobotwire.diagnose import Finding, Item, Unrecognised, words
from cobotwire.explain import Reading, parts, readings, summary
from cobotwire.table import Direction, FrameFormat

# A polled arm says the same over and over: so many different frames are remembered in words.
REMEMBERED = 4096
# So many bytes of a finding are shown on its line.
SHOWN = 16

Show = Callable[[Item], str]
Reader = Callable[[bytes], tuple[Reading, ...]]


def reader(codec: Codec, directions: tuple[Direction, ...]) -> Reader:
    """Reads bytes in each direction that their id and LEN fit, or in all, to say why they do not.

    The last of them are remembered.
    """
    frame = codec.table.frame
    fits: dict[bytes, list[Direction]] = {}
    for direction in directions:
        for command in codec.table.commands:
            for form in command.layouts(direction):
                ways = fits.setdefault(bytes([frame.length(form.size), command.id]), [])
                if direction not in ways:
                    ways.append(direction)

    def read(data: bytes) -> tuple[Reading, ...]:
        ways = fits.get(data[frame.length_at : frame.length_at + 2], directions)
        return readings(codec, data, tuple(ways))

    return lru_cache(REMEMBERED)(read)


def on_a_line(read: Reader, colour: bool) -> Show:
    """Where it stands, what it is, its bytes, and what they say."""
    meaning = lru_cache(REMEMBERED)(lambda data: _meaning(read(data)))

    def show(item: Item) -> str:
        if isinstance(item, Frame):
            kind, said, colours = "frame", meaning(item.data), "green"
        else:
            kind, said = item.kind, words(item)
            colours = "red" if isinstance(item, Unrecognised) else "yellow"
        label = click.style(f"{kind:<14}", fg=colours) if colour else f"{kind:<14}"
        return f"{item.offset:>8}  {label}  {_bytes(item)}  {said}{_pieces(item)}"

    return show


def _meaning(found: tuple[Reading, ...]) -> str:
    return " | ".join(
        f"as a {r.direction}: {r.error}"
        if r.message is None
        else f"{r.direction}: {summary(r.message)}"
        for r in found
    )


def _bytes(item: Item) -> str:
    data = item.data
    if isinstance(item, Frame) or len(data) <= SHOWN:
        return data.hex(" ").upper()
    return f"{data[:SHOWN].hex(' ').upper()} ... {len(data)} bytes"


def _pieces(item: Item) -> str:
    if isinstance(item, Frame):
        return ""
    around = f" (in {len(item.spans)} pieces)" if len(item.spans) > 1 else ""
    return around + (" (continued)" if item.continued else "")


def byte_by_byte(read: Reader, frame: FrameFormat) -> Show:
    """Each byte of a frame on a line of its own; all bytes of noise, and why they are no frame."""

    def show(item: Item) -> str:
        data = item.data
        if isinstance(item, Frame):
            lines = [f"frame   {data.hex(' ').upper()}"]
            for reading in read(data):
                lines.extend(_reading(frame, data, reading))
            return "\n".join(lines)
        lines = [f"noise   {data.hex(' ').upper()}   {item.reason}", f"  {words(item)}"]
        lines += [f"  as a {r.direction}: {r.error}" for r in read(data) if r.error is not None]
        return "\n".join(lines)

    return show


def _reading(frame: FrameFormat, data: bytes, reading: Reading) -> list[str]:
    if reading.message is None:
        return [f"  as a {reading.direction}: {reading.error}"]
    lines = [f"  {reading.direction}: {summary(reading.message)}"]
    for part in parts(frame, data, reading.message):
        shown = part.data.hex(" ").upper()
        lines.append(f"    {part.offset:>3}  {shown:<6} {part.name:<14} {part.meaning}")
    return lines


def as_json(read: Reader) -> Show:
    """One JSON object an event."""
    return lambda item: json.dumps(as_object(read, item))


def as_object(read: Reader, item: Item) -> dict[str, Any]:
    """An event as JSON knows it."""
    data = item.data
    common = {"offset": item.offset, "data": data.hex(" ").upper()}
    said = {"readings": [_reading_json(reading) for reading in read(data)]}
    if isinstance(item, Frame):
        legal = any(reading.message for reading in read(data))
        return {"kind": "frame", **common, "legal": legal, **said}
    noise = {"kind": "noise", **common, "legal": False, "reason": item.reason}
    return {**noise, **said, **_finding_json(item)}


def _finding_json(finding: Finding) -> dict[str, Any]:
    facts = {
        name: fact.hex(" ").upper() if isinstance(fact, bytes) else fact
        for name, fact in finding.facts.items()
    }
    return {
        "finding": finding.kind,
        "says": words(finding),
        "facts": facts,
        "pieces": [[span.offset, len(span.data)] for span in finding.spans],
        "continued": finding.continued,
    }


def _reading_json(reading: Reading) -> dict[str, Any]:
    if reading.message is None:
        return {"direction": reading.direction, "error": str(reading.error)}
    fields = {name: plain(value) for name, value in reading.message.fields.items()}
    return {
        "direction": reading.direction,
        "command": reading.message.command.name,
        "fields": fields,
    }
