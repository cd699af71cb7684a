"""Proposes types and effects of unknown messages by their values: unit, scale, sign, pairs."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Iterator, Sequence
from contextlib import suppress
from fractions import Fraction

from cobotwire_codegen.author.draft import read
from cobotwire_codegen.author.guess import Guess
from cobotwire_codegen.author.scan import Seen
from cobotwire_codegen.model import Edition, Enum, Flag, Quantity
from cobotwire_codegen.render.words import decimal

# With fewer different values, almost any type fits.
_LEAST = 3
# A type with this many values or more is not taken for an enum.
_FEW = 32
_SCALES = tuple(Fraction(scale) for scale in ("1/1000", "1/100", "1/10", "1"))
# Known numbers by COMMAND.FIELD[INDEX], each with its type, and the offset and value of each reply.
Known = dict[str, tuple[Quantity, list[int], list[Fraction]]]


def known_values(edition: Edition, frames: Sequence[Seen]) -> Known:
    """Return the numbers of all replies that the edition reads, in the order of the capture."""
    # Use the first of the commands that share an id.
    commands = {each.id: each for each in reversed(edition.commands) if each.awaits_reply}
    found: Known = {}
    for seen in frames:
        if seen.id not in commands or not seen.data or seen.direction == "request":
            continue
        with suppress(ValueError):
            command = commands[seen.id]
            for name, value in read(edition, command, "reply", seen.frame).items():
                field = next(field for field in command.reply if field.name == name)
                values = value if isinstance(value, tuple) else (value,)
                for index, ((_, part), number) in enumerate(zip(field.type.parts, values)):
                    if isinstance(part, Quantity) and isinstance(number, int | Fraction):
                        key = f"{command.name}.{name}[{index}]"
                        _, at, all_of = found.setdefault(key, (part, [], []))
                        at.append(seen.offset)
                        all_of.append(Fraction(number))
    return found


def fitting(edition: Edition, item: Guess, frames: Sequence[Seen], known: Known) -> tuple[str, str]:
    """Return the name of the type that fits the values of some bytes best, and why.

    A known number that had the same values at the same time is preferred; otherwise the type with
    the narrowest range that holds all of the values. The name is empty if no type fits. Then the
    reason is empty too, unless a known number of another size or scale had the same values.
    """
    pieces = [seen.data[item.first : item.first + item.width] for seen in frames]
    if item.kind not in ("word", "byte", "enum", "flag") or len({*pieces}) < (
        2 if item.kind == "flag" else _LEAST
    ):
        return "", ""
    key, near, scale = _following(pieces, frames, known)
    if near is not None and (near.size, near.scale) != (item.width, scale):
        return "", f"equals {key}; it needs a new quantity: {near.unit}, scale {scale}"
    fits = [
        (_width(type), type)
        for type in (edition.types if near is None else (near,))
        if isinstance(type, Quantity | Enum | Flag)
        and (item.kind == "flag") == isinstance(type, Flag)
        and type.size == item.width
        and (item.kind != "enum" or _width(type) < _FEW)
        and all(_legal(type, piece) for piece in pieces)
    ]
    if not fits:
        return "", ""
    type = min(fits, key=lambda fit: fit[0])[1]
    why = f"equals {key}" if key else f"fits {type.name}"
    if not isinstance(type, Quantity):
        return type.name, why
    values = [type.exact(type.wire.raw_of(piece)) for piece in pieces]
    signed = "signed" if type.wire.minimum < 0 else "unsigned"
    span = f"{decimal(min(values))}..{decimal(max(values))} {type.unit}".rstrip()
    return type.name, f"{why}: {span}, scale {type.scale}, {signed}"


def _following(
    pieces: Sequence[bytes], frames: Sequence[Seen], known: Known
) -> tuple[str, Quantity | None, Fraction]:
    """Return the key and type of the known number that the values follow, and the values' scale.

    The key is empty, and the type None, if they follow no known number.
    """
    raws = [int.from_bytes(piece, "big", signed=len(piece) > 1) for piece in pieces]
    for key, (type, at, numbers) in known.items():
        before = [bisect(at, seen.offset) - 1 for seen in frames]
        if min(before) < 0 or len({numbers[index] for index in before}) < _LEAST:
            continue
        for scale in _SCALES:
            if all(raw * scale == numbers[index] for raw, index in zip(raws, before)):
                return key, type, scale
    return "", None, Fraction(1)


def _legal(type: Quantity | Enum | Flag, piece: bytes) -> bool:
    raw = type.wire.raw_of(piece)
    if type.choices:
        return raw in type.choices
    return isinstance(type, Quantity) and type.bounds[0] <= raw <= type.bounds[1]


def _width(type: Quantity | Enum | Flag) -> Fraction:
    if type.choices:
        return Fraction(len(type.choices))
    assert isinstance(type, Quantity), "other types have choices"
    return type.bounds[1] - type.bounds[0]


def pairs(groups: Sequence[Sequence[Seen]]) -> Iterator[tuple[Seen, Seen]]:
    """Yield pairs of messages, each by its first frame; the second repeats the first one's data."""
    for stored in groups:
        for reported in groups:
            if stored[0].id == reported[0].id or len(stored[0].data) != len(reported[0].data):
                continue
            if stored[0].direction == "reply" or reported[0].direction == "request":
                continue
            at = [seen.offset for seen in stored]
            before = [bisect(at, seen.offset) - 1 for seen in reported]
            if (
                min(before) >= 0
                and len({stored[index].data for index in before}) >= _LEAST
                and all(stored[i].data == seen.data for i, seen in zip(before, reported))
            ):
                yield stored[0], reported[0]
