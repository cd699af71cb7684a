"""Format frames and findings: on one line, byte by byte, or as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import click

from cobotwire.cli.shared.hex_colours import Paint
from cobotwire.cli.shared.output import as_hex
from cobotwire.codec.interface import Frame
from cobotwire.diagnose.explain import (
    DIRECTIONS,
    REMEMBERED,
    FrameReader,
    Reading,
    format_message,
    frame_parts,
)
from cobotwire.protocol.json_values import as_json_value
from cobotwire.protocol.table import Table

if TYPE_CHECKING:
    from cobotwire.diagnose import Finding, Item
    from cobotwire.diagnose.stream_summary import LineTexts

# How many bytes of a finding its line shows.
SHOWN = 16

Format = Callable[["Item"], str]


def one_line(reader: FrameReader, paint: Paint | None) -> Format:
    """Return a formatter: offset, kind, bytes and meaning; with colours if there is ``paint``."""
    meaning = lru_cache(REMEMBERED)(lambda data: " | ".join(map(_reading, reader.read(data))))

    def format(item: Item) -> str:
        if isinstance(item, Frame):
            kind, text, label_colour = "frame", meaning(item.data), "green"
        else:
            from cobotwire.diagnose import Unrecognised

            kind, text = item.kind, item.describe()
            label_colour = "red" if isinstance(item, Unrecognised) else "yellow"
        label, shown = f"{kind:<14}", _first_bytes(item)
        if paint is not None:
            label = click.style(label, fg=label_colour)
            is_frame = isinstance(item, Frame)
            shown = paint(item.data) if is_frame else click.style(shown, fg=label_colour)
        return f"{item.offset:>8}  {label}  {shown}  {text}{_pieces(item)}"

    return format


def _reading(reading: Reading) -> str:
    if reading.message is None:
        return f"as a {reading.direction}: {reading.error}"
    word = "event" if reading.message.command.event else reading.direction
    return f"{word}: {format_message(reading.message)}"


def _first_bytes(item: Item) -> str:
    data = item.data
    if isinstance(item, Frame) or len(data) <= SHOWN:
        return as_hex(data)
    return f"{as_hex(data[:SHOWN])} ... {len(data)} bytes"


def _pieces(item: Item) -> str:
    if isinstance(item, Frame):
        return ""
    around = f" (in {len(item.spans)} pieces)" if len(item.spans) > 1 else ""
    return around + (" (continued)" if item.continued else "")


def byte_by_byte(reader: FrameReader, table: Table, paint: Paint | None) -> Format:
    """Return a formatter: a line for each byte of a frame; for noise, why it is not a frame."""

    def format(item: Item) -> str:
        readings = reader.read(item.data)
        if isinstance(item, Frame):
            lines = [f"frame   {paint(item.data) if paint else as_hex(item.data)}"]
            for reading in readings:
                lines.append(f"  {_reading(reading)}")
                lines += _parts(table, item.data, reading)
            return "\n".join(lines)
        shown = click.style(as_hex(item.data), fg="red") if paint else as_hex(item.data)
        lines = [f"noise   {shown}   {item.reason}", f"  {item.describe()}"]
        lines += [f"  {_reading(reading)}" for reading in readings if reading.error is not None]
        return "\n".join(lines)

    return format


def _parts(table: Table, data: bytes, reading: Reading) -> list[str]:
    if reading.message is None:
        return []
    return [
        f"    {part.offset:>3}  {as_hex(part.data):<6} {part.name:<14} {part.meaning}"
        for part in frame_parts(table, data, reading.message)
    ]


def as_object(reader: FrameReader, item: Item) -> dict[str, Any]:
    """Return a frame or finding as a JSON object."""
    readings = reader.read(item.data)
    common = {"offset": item.offset, "data": as_hex(item.data)}
    described = {"readings": [_reading_object(reading) for reading in readings]}
    if isinstance(item, Frame):
        legal = any(reading.message for reading in readings)
        return {"kind": "frame", **common, "legal": legal, **described}
    noise = {"kind": "noise", **common, "legal": False, "reason": item.reason}
    return {**noise, **described, **_finding_object(item)}


def line_texts(table: Table, file: str | None) -> LineTexts:
    """Return the texts for the native codec's lines, equal to those of :func:`as_object`.

    ``file`` is the first value of each line; None: lines name no file.
    """
    from cobotwire.diagnose.stream_summary import LineTexts

    requests, replies = (
        [
            [[json.dumps(field.name) for field in variant.fields] for variant in variants]
            for variants in (command.variants(direction) for command in table.commands)
        ]
        for direction in DIRECTIONS
    )
    return LineTexts(
        first="" if file is None else f'"file": {json.dumps(file)}, ',
        commands=[json.dumps(command.name) for command in table.commands],
        requests=requests,
        replies=replies,
        describe=lambda finding: json.dumps(_description(finding))[1:-1],
    )


def _finding_object(finding: Finding) -> dict[str, Any]:
    return {
        "finding": finding.kind,
        **_description(finding),
        "pieces": [[span.offset, len(span.data)] for span in finding.spans],
        "continued": finding.continued,
    }


def _description(finding: Finding) -> dict[str, Any]:
    facts = {
        name: as_hex(fact) if isinstance(fact, bytes) else fact
        for name, fact in finding.facts.items()
    }
    return {"text": finding.describe(), "facts": facts}


def _reading_object(reading: Reading) -> dict[str, Any]:
    if reading.message is None:
        return {"direction": reading.direction, "error": str(reading.error)}
    message = reading.message
    fields = {name: as_json_value(value) for name, value in message.fields.items()}
    to = {} if message.address is None else {"address": message.address}
    described = {"direction": reading.direction, "command": message.command.name}
    return {**described, **to, "fields": fields}
