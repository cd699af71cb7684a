"""Writes a new command and its first vectors as lines of YAML."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from textwrap import wrap
from typing import Literal

from cobotwire_codegen.model import Command, Edition
from cobotwire_codegen.render.words import decimal
from cobotwire_codegen.wire import build_frame

Direction = Literal["request", "reply"]
_PLAIN = re.compile(r"[A-Za-z][\w ,.;()'/+=-]*\Z")
# Words that YAML does not read as text.
_NO_TEXT = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


@dataclass(frozen=True, slots=True)
class Draft:
    """A new command. Each field of request and reply is a name, a type, and whether it echoes."""

    name: str
    id: int
    title: str
    doc: str
    safety: str
    source: str
    request: tuple[tuple[str, str, bool], ...]
    reply: tuple[tuple[str, str, bool], ...]
    effect: str = ""


def command_lines(draft: Draft) -> list[str]:
    """Return the entry of the commands file."""
    lines = [f"{draft.name}:", f"  id: 0x{draft.id:02X}"]
    lines += [f"  title: {_scalar(draft.title)}", *_long("  doc", draft.doc)]
    lines.append(f"  safety: {draft.safety}")
    if draft.effect:
        lines.append(f"  effect: {draft.effect}")
    if draft.source:
        lines.append(f"  source: [{draft.source}]")
    for key, fields in (("request", draft.request), ("reply", draft.reply)):
        if fields:
            lines.append(f"  {key}:")
        for name, type, echo in fields:
            more = ", echo: required" if echo else ""
            lines.append(f"    - {{name: {name}, type: {type}{more}}}")
    return lines


def vector_lines(
    name: str,
    command: str,
    direction: Direction,
    frame: bytes,
    values: dict[str, object],
    source: str = "",
    seen: bool = False,
) -> list[str]:
    """Return an entry of the vectors file; ``seen``: the frame was captured, not computed."""
    lines = [f"- name: {name}", f"  command: {command}", f"  direction: {direction}"]
    if source:
        lines.append(f"  source: [{source}]")
    lines.append(f"  frame: {frame.hex(' ').upper()}")
    if values:
        shown = ", ".join(f"{name}: {_value(value)}" for name, value in values.items())
        lines.append(f"  values: {{{shown}}}")
    if not seen:
        lines.append("  why: Computed from the variant; a captured frame would be better evidence.")
    return lines


def read(
    edition: Edition, command: Command, direction: Direction, frame: bytes
) -> dict[str, object]:
    """Return the values that a frame carries, read as the first variant that it fits.

    Raises:
        ValueError: the frame is not that message.
    """
    for variant in command.variants(direction):
        widths = [field.type.size for field in variant]
        start = len(frame) - edition.frame.check_size - sum(widths)
        if start < 0:
            continue
        values: dict[str, object] = {}
        for field, width in zip(variant, widths):
            values[field.name] = field.type.read(frame[start : start + width])
            start += width
        address = edition.frame.address_in(frame)
        if _encodes(edition, command, direction, values, address) == frame:
            return values
    raise ValueError(f"{frame.hex(' ').upper()} is not the described {direction}")


def _encodes(
    edition: Edition,
    command: Command,
    direction: Direction,
    values: dict[str, object],
    address: int | None,
) -> bytes | None:
    try:
        return build_frame(edition.frame, command, direction, values, address)
    except ValueError:
        return None


def _value(value: object) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str) and not value.isidentifier():
        return f'"{value}"'
    return decimal(value) if isinstance(value, Fraction) else str(value)


def _scalar(text: str) -> str:
    if _PLAIN.match(text) and text.lower() not in _NO_TEXT and text == text.strip():
        return text
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _long(key: str, text: str) -> Iterator[str]:
    if len(text) <= 80:
        yield f"{key}: {_scalar(text)}"
        return
    yield f"{key}: >-"
    yield from (f"    {line}" for line in wrap(text, 90, break_long_words=False))
