"""Makes vectors of every variant of every message: ordinary values, bounds, choices, rejections."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import NamedTuple

from cobotwire_codegen.model import Command, Edition, Field, Listed, Variant
from cobotwire_codegen.targets.vectors.law import Direction
from cobotwire_codegen.targets.vectors.sizes import fixed_sizes, some
from cobotwire_codegen.targets.vectors.slots import RawValues, Slot, case_choices, slots
from cobotwire_codegen.wire import enclose

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
# Each ordinary number lies at a different share of its range, and none in the middle, so that a
# wrong order of fields, bytes or cases is detected.
SHARES = (0.61, 0.23, 0.83, 0.37, 0.71, 0.13, 0.53)


class Example(NamedTuple):
    """A message by its raw values, and its bytes.

    ``number`` counts the variants of the command's message as the spec states them: a variant with
    lists counts once for all sizes. ``variant`` has the sizes of this example.
    """

    what: str
    command: Command
    direction: Direction
    variant: Variant
    number: int
    raw_values: RawValues
    data: bytes


class Beyond(NamedTuple):
    """A message with one number that the edition does not allow.

    ``data`` is the encoded message, None if no bytes decode to that number. With ``letter`` it is a
    byte of a text.
    """

    example: Example
    field: Field
    element: int
    raw: int
    data: bytes | None
    letter: bool


def examples(edition: Edition) -> Iterator[Example]:
    """Yield every variant and case, with the bounds and choices of every number."""
    for command, direction, number, variant in variants(edition):
        seen: set[bytes] = set()
        for what, raw_values in _raw_values(variant):
            data = encode(edition, command, direction, variant, raw_values)
            # If a variant has few legal values, its bounds and its choices give the same messages.
            if data not in seen:
                seen.add(data)
                yield Example(what, command, direction, variant, number, raw_values, data)


def variants(edition: Edition) -> Iterator[tuple[Command, Direction, int, Variant]]:
    """Yield every variant of every framed message, with its number and with some of its sizes."""
    for command in edition.commands:
        for direction in DIRECTIONS:
            for number, variant in enumerate(command.variants(direction)):
                for each in some(fixed_sizes(variant, edition.frame.maximum_data)):
                    yield command, direction, number, each


def beyond(edition: Edition, example: Example) -> Iterator[Beyond]:
    """Yield the nearest illegal values of each number of a message."""
    for field in example.variant:
        parts = slots(field, example.variant, example.raw_values)
        assert parts is not None, "an example has a case for every field"
        for element, slot in enumerate(parts):
            for raw in _outside(slot):
                numbers = list(example.raw_values[field.name])
                numbers[element] = raw
                raw_values = example.raw_values | {field.name: tuple(numbers)}
                encodable = slot.encodable(raw) and not _picks(field, example.variant)
                data = (
                    encode(edition, example.command, example.direction, example.variant, raw_values)
                    if encodable
                    else None
                )
                yield Beyond(example, field, element, raw, data, slot.letter)


def encode(
    edition: Edition,
    command: Command,
    direction: Direction,
    variant: Variant,
    raw_values: RawValues,
) -> bytes:
    """Return the frame with these raw values, legal or not."""
    data = b""
    for field in variant:
        word = b""
        for slot, raw in zip(slots(field, variant, raw_values) or (), raw_values[field.name]):
            word = slot.encode(raw, word)
            if not slot.more:
                data, word = data + word, b""
    return enclose(edition.frame, command.id, data, direction)


def _picks(field: Field, variant: Variant) -> bool:
    """Return whether another field's case depends on this field; then its size is unknown."""
    return any(other.selector == field.name for other in variant)


def _outside(slot: Slot) -> Iterator[int]:
    if slot.takes_nan:
        return
    if not slot.choices:
        yield slot.lowest - 1
        yield slot.highest + 1
        return
    yield from sorted({raw + 1 for raw in slot.choices} - set(slot.choices))[:2]
    yield min(slot.choices) - 1


def _raw_values(variant: Variant) -> Iterator[tuple[str, RawValues]]:
    for picked in case_choices(variant):
        case = "".join(f", {name} {value}" for name, value in picked.items())
        for what, choose in _CHOOSERS:
            yield what + case, _message(variant, picked, choose)
    for field in variant:
        yield from _choices(variant, field)


def _choices(variant: Variant, field: Field) -> Iterator[tuple[str, RawValues]]:
    """Yield a message for each member of a closed list."""
    ordinary = _message(variant, {}, _ordinary)
    for element, slot in enumerate(slots(field, variant, ordinary) or ()):
        for choice in slot.choices:
            if field.selector or len(ordinary[field.name]) > 1:
                numbers = list(ordinary[field.name])
                numbers[element] = choice
                yield f"{field.name} {choice}", ordinary | {field.name: tuple(numbers)}
            else:
                yield f"{field.name} {choice}", _message(variant, {field.name: choice}, _ordinary)


Choose = Callable[[Slot, int], int]


def _message(variant: Variant, picked: dict[str, int], choose: Choose) -> RawValues:
    raw_values: RawValues = {}
    count = 0
    # Selectors come first: they decide which values the other fields may have.
    for field in sorted(variant, key=lambda field: bool(field.selector)):
        parts = slots(field, variant, raw_values)
        assert parts is not None, "every value that is chosen for a selector has a case"
        numbers = []
        for slot in parts:
            numbers.append(picked.get(field.name, choose(slot, count)))
            count += 1
        raw_values[field.name] = tuple(numbers)
        if choose is _ordinary and all(slot.utf8 for slot in parts):
            raw_values[field.name] = _accented(field, numbers)
    return {field.name: raw_values[field.name] for field in variant}


def _accented(field: Field, letters: list[int]) -> tuple[int, ...]:
    """Return the bytes of texts with ``é`` at the start of each, if it has two bytes."""
    size = field.type.of.size if isinstance(field.type, Listed) else len(letters)
    starts = range(0, len(letters), size) if size > 1 else ()
    for at in starts:
        letters[at : at + 2] = b"\xc3\xa9"
    return tuple(letters)


def _ordinary(slot: Slot, count: int) -> int:
    share = SHARES[count % len(SHARES)]
    if slot.choices:
        return slot.choices[int(share * len(slot.choices))]
    lowest, highest = slot.ends
    if slot.letter:
        lowest, highest = ord("a"), ord("z")
    # Fractions are needed, since a double cannot hold the raw values of a float of eight bytes.
    return round(lowest + Fraction(share) * (highest - lowest))


def _nearest(wanted: int) -> Choose:
    def choose(slot: Slot, count: int) -> int:
        lowest, highest = slot.ends
        allowed = slot.choices or (min(max(wanted, lowest), highest),)
        return min(allowed, key=lambda raw: abs(raw - wanted))

    return choose


def _not_a_number(slot: Slot, count: int) -> int:
    """Return the usual NaN where a float may be one."""
    if not slot.takes_nan:
        return _ordinary(slot, count)
    return 0x7FC0_0000 if slot.wire.width == 4 else 0x7FF8_0000_0000_0000


_CHOOSERS: tuple[tuple[str, Choose], ...] = (
    ("ordinary", _ordinary),
    ("lowest", lambda slot, count: min(slot.choices) if slot.choices else slot.ends[0]),
    ("highest", lambda slot, count: max(slot.choices) if slot.choices else slot.ends[1]),
    ("zero", _nearest(0)),
    ("minus one", _nearest(-1)),
    ("not a number", _not_a_number),
)
