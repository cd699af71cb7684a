"""A new command and its first vectors, as lines of YAML."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from textwrap import wrap
from typing import Literal

from cobotwire_codegen.model import Command, Edition, Enum, Flag, Type, Value
from cobotwire_codegen.render.words import decimal
from cobotwire_codegen.wire import build_frame, size

Direction = Literal["request", "reply"]
_PLAIN = re.compile(r"[A-Za-z][\w ,.;()'/+=-]*\Z")
# Words that YAML takes for something else.
_NO_TEXT = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


@dataclass(frozen=True, slots=True)
class Draft:
    """What is said of a new command. A field is its name, its type and whether it is an echo."""

    name: str
    id: int
    title: str
    doc: str
    safety: str
    source: str
    request: tuple[tuple[str, str, bool], ...]
    reply: tuple[tuple[str, str, bool], ...]


def command_lines(draft: Draft) -> list[str]:
    """The entry of the commands file."""
    lines = [f"{draft.name}:", f"  id: 0x{draft.id:02X}"]
    lines += [f"  title: {_scalar(draft.title)}", *_long("  doc", draft.doc)]
    lines.append(f"  safety: {draft.safety}")
    if draft.source:
        lines.append(f"  source: [{draft.source}]")
    for key, fields in (("request", draft.request), ("reply", draft.reply)):
        if fields:
            lines.append(f"  {key}:")
        for name, type, echo in fields:
            more = ", echo: required" if echo else ""
            lines.append(f"    - {{name: {name}, is: {type}{more}}}")
    return lines


def vector_lines(
    draft: Draft,
    direction: Direction,
    which: int,
    frame: bytes,
    values: dict[str, object],
    seen: bool,
) -> list[str]:
    """An entry of the vectors file; ``which`` counts the forms of the message from 0."""
    lines = [
        f"- name: {draft.name.replace('_', '-')}-{direction}{f'-{which + 1}' if which else ''}",
        f"  command: {draft.name}",
        f"  direction: {direction}",
    ]
    if draft.source:
        lines.append(f"  source: [{draft.source}]")
    lines.append(f"  frame: {frame.hex(' ').upper()}")
    if values:
        shown = ", ".join(f"{name}: {_value(value)}" for name, value in values.items())
        lines.append(f"  values: {{{shown}}}")
    if not seen:
        lines.append("  why: Computed from the layout; a frame that was seen on a line is better.")
    return lines


def smallest(type: Type) -> object:
    """The smallest legal value of a type."""
    if isinstance(type, Flag):
        return False
    if isinstance(type, Enum):
        return min(type.members, key=lambda member: member.value).name
    if isinstance(type, Value):
        return tuple(smallest(item) for _, item in type.items)
    return _plain(type.bounds[0] * type.scale)


def read(
    edition: Edition, command: Command, direction: Direction, frame: bytes
) -> dict[str, object]:
    """The values that a frame carries, which must have the message's full form.

    Raises:
        ValueError: the frame is not that message.
    """
    form = command.forms(direction)[0]
    widths = [size(field.type) for field in form]
    start = len(frame) - edition.frame.check_size - sum(widths)
    values: dict[str, object] = {}
    for field, width in zip(form, widths):
        values[field.name] = _read(field.type, frame[max(start, 0) : max(start, 0) + width])
        start += width
    if build_frame(edition.frame, command, direction, values) != frame:
        raise ValueError(f"{frame.hex(' ').upper()} is not the {direction} that is described")
    return values


def _read(type: Type, data: bytes) -> object:
    if isinstance(type, Value):
        values = []
        for _, item in type.items:
            values.append(_read(item, data[: item.wire.width]))
            data = data[item.wire.width :]
        return tuple(values)
    raw = int.from_bytes(data, type.wire.order)
    whole = raw - 256**type.wire.width if raw > type.wire.signed_at else raw
    if isinstance(type, Flag):
        return whole == 1
    if isinstance(type, Enum):
        names = {member.value: member.name for member in type.members}
        return names.get(whole, str(whole))
    return _plain(whole * type.scale)


def _plain(exact: Fraction | int) -> object:
    exact = Fraction(exact)
    return int(exact) if exact.denominator == 1 else exact


def _value(value: object) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
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
