"""``cobotwire decode``: what each byte is."""

from __future__ import annotations

import json
import re
import sys
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.call import plain
from cobotwire.codec.interface import Frame, Noise
from cobotwire.errors import UsageError
from cobotwire.explain import DIRECTIONS, Explained, Reading, explain, parts, summary
from cobotwire.table import Direction, FrameFormat

_SEPARATORS = re.compile(r"0[xX]|[\s,;:]+")


@click.command()
@click.argument("hex_bytes", nargs=-1, required=True, metavar="HEX...")
@click.option(
    "--direction",
    type=click.Choice(["request", "reply", "both"]),
    default="both",
    show_default=True,
    help="Which way the bytes went.",
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a line.")
@click.pass_obj
def decode(edition: str, hex_bytes: tuple[str, ...], direction: str, as_json: bool) -> None:
    """Explain bytes: HEX pairs with or without spaces, commas or 0x.

    Exit code 1 if there is anything among them that is no legal frame.
    """
    table = editions.load(edition).TABLE
    directions: tuple[Direction, ...] = tuple(d for d in DIRECTIONS if direction in (d, "both"))
    found = explain(codecs.load(table), _bytes(hex_bytes), directions)
    for explained in found:
        if as_json:
            click.echo(json.dumps(_as_json(explained)))
        else:
            click.echo("\n".join(_lines(table.frame, explained)))
    sys.exit(0 if all(explained.legal for explained in found) else 1)


def _bytes(words: tuple[str, ...]) -> bytes:
    text = _SEPARATORS.sub("", " ".join(words))
    try:
        return bytes.fromhex(text)
    except ValueError:
        raise UsageError("HEX", " ".join(words), "pairs of hex digits") from None


def _lines(frame: FrameFormat, explained: Explained) -> list[str]:
    event = explained.event
    if isinstance(event, Noise):
        lines = [f"noise   {event.data.hex(' ').upper()}   {event.reason}"]
        return lines + [f"  as a {r.direction}: {r.error}" for r in explained.readings]
    lines = [f"frame   {event.data.hex(' ').upper()}"]
    for reading in explained.readings:
        lines.extend(_reading(frame, event, reading))
    return lines


def _reading(frame: FrameFormat, event: Frame, reading: Reading) -> list[str]:
    if reading.message is None:
        return [f"  as a {reading.direction}: {reading.error}"]
    lines = [f"  {reading.direction}: {summary(reading.message)}"]
    for part in parts(frame, event.data, reading.message):
        shown = part.data.hex(" ").upper()
        lines.append(f"    {part.offset:>3}  {shown:<6} {part.name:<14} {part.meaning}")
    return lines


def _as_json(explained: Explained) -> dict[str, Any]:
    event = explained.event
    common = {"offset": event.offset, "data": event.data.hex(" ").upper(), "legal": explained.legal}
    readings = [_reading_json(reading) for reading in explained.readings]
    if isinstance(event, Noise):
        return {"kind": "noise", **common, "reason": event.reason, "readings": readings}
    return {"kind": "frame", **common, "readings": readings}


def _reading_json(reading: Reading) -> dict[str, Any]:
    if reading.message is None:
        return {"direction": reading.direction, "error": str(reading.error)}
    fields = {name: plain(value) for name, value in reading.message.fields.items()}
    return {
        "direction": reading.direction,
        "command": reading.message.command.name,
        "fields": fields,
    }
