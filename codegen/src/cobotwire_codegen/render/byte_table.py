"""Prepares the byte table of a message: its fixed parts, its fields and its check."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Edition, Field, Frame, FrameNumber, Value
from cobotwire_codegen.model.frame import Direction
from cobotwire_codegen.render.diagram import FIXED, Row, label
from cobotwire_codegen.render.markdown import wire_encoding
from cobotwire_codegen.wire import size

_SHOWN = 8


def byte_rows(
    edition: Edition, command: Command, direction: Direction, variant: tuple[Field, ...]
) -> Iterator[Row]:
    """Yield the rows of a message's byte table: position, content, value."""
    frame = edition.frame
    yield _place(0, len(frame.header)), "header", frame.header.hex(" ").upper()
    for part in frame.layout:
        place = _place(frame.offset(part), frame.sizes[part])
        if part == "length":
            yield place, "LEN", _lengths(frame, direction, variant)
        elif part == "command" and frame.has_command(direction):
            yield place, "CMD", _digits(frame.command_number, command.id)
        elif part == "address" and frame.address_values:
            yield place, "address", _addresses(frame)
    ruler = _Ruler(frame.data_at(direction))
    for field in variant:
        for name, width, content in _parts(field):
            yield ruler.place(None if field.type.varies else width), name, content
    yield from _ending(frame, ruler)


def only_fixed(rows: Iterable[Row]) -> bool:
    """Return whether a message consists of fixed bytes only, so that it has a single frame."""
    return all(content in FIXED for _, content, _ in rows)


def on_one_line(rows: Iterable[Row]) -> str:
    """Return a message on one line, as bytes and names of fields."""
    return " ".join(label(content, value) for _, content, value in rows)


class _Ruler:
    """Numbers bytes. After a part whose size varies, it counts from the last byte of that part."""

    def __init__(self, position: int) -> None:
        self._next, self._after = position, ""
        self._letters = iter("nmkjihgfedcba" * 20)

    def place(self, width: int | None) -> str:
        """Return the positions of the next part; its width is None if it varies."""
        if not self._after and width is not None:
            self._next += width
            return _place(self._next - width, width)
        first = f"{self._after}+{self._next}" if self._after else str(self._next)
        if width is None:
            self._after, self._next = next(self._letters), 1
            return f"{first}-{self._after}"
        self._next += width
        return first if width == 1 else f"{first}..{self._after}+{self._next - 1}"


def _lengths(frame: Frame, direction: Direction, variant: tuple[Field, ...]) -> str:
    """Return LEN, or the range of LEN if the size of the message varies."""
    sizes = [
        (size(f.type), f.type.sizes[1] * f.type.element_size) for f in variant if f.type.varies
    ]
    fixed = sum(size(field.type) for field in variant if not field.type.varies)
    most = min(fixed + sum(high for _, high in sizes), frame.maximum_data)
    ends = dict.fromkeys((fixed + sum(low for low, _ in sizes), most))
    return "..".join(_digits(frame.length_number, frame.length(n, direction)) for n in ends)


def _place(position: int, width: int) -> str:
    return str(position) if width == 1 else f"{position}-{position + width - 1}"


def _digits(form: FrameNumber, number: int) -> str:
    return number.to_bytes(form.width, form.order).hex(" ").upper()


def _addresses(frame: Frame) -> str:
    shown = [f"{member.value:02X} {member.name}" for member in frame.addresses[:_SHOWN]]
    if frame.address_range:
        shown.append(f"{frame.address_range[0]:02X}..{frame.address_range[-1]:02X}")
    return ", ".join(shown)


def _ending(frame: Frame, ruler: _Ruler) -> Iterator[Row]:
    if frame.check is not None:
        yield ruler.place(frame.check.width), "check", check_words(frame)
    if frame.footer:
        yield ruler.place(len(frame.footer)), "footer", frame.footer.hex(" ").upper()


def check_words(frame: Frame) -> str:
    """Describe the check in words."""
    check = frame.check
    if check is None:
        return ""
    start = {"header": "all bytes before it", "data": "the data", "command": "CMD and DATA"}
    if frame.layout[-1] != "command":
        del start["command"]
    part = {"length": "LEN", "command": "CMD"}.get(check.covers_from, check.covers_from)
    order = "" if check.width == 1 else f", {_FIRST[check.order]} byte first"
    return f"{check.word} over {start.get(check.covers_from, f'the bytes from {part} on')}{order}"


_FIRST = {"big": "high", "little": "low"}


def _parts(field: Field) -> Iterator[tuple[str, int, str]]:
    types = [type for _, type in lower.cases(field)]
    first = types[0]
    if not isinstance(first, Value):
        yield f"`{field.name}`", size(first), " or ".join(wire_encoding(type) for type in types)
        return
    for index, (part, item) in enumerate(first.items):
        kinds = dict.fromkeys(
            wire_encoding(type.items[index][1]) for type in types if isinstance(type, Value)
        )
        names = dict.fromkeys(type.items[index][0] for type in types if isinstance(type, Value))
        yield f"`{field.name}` {'/'.join(names) or part}", item.wire.width, " or ".join(kinds)
