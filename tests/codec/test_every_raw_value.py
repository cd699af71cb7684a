"""All 65,536 raw values of every scaled 16-bit field survive decode and encode, or are rejected."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple, TypeVar

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions import mycobot, mycobot280
from cobotwire.protocol.checks import ByteOrder
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Case, Command, Direction, Number, Table, Variant

WORDS = 65_536
T = TypeVar("T")


class Slot(NamedTuple):
    """A scaled 16-bit number of a variant; its selector, if any, holds the case's first value."""

    field: int
    element: int
    case: Case
    position: int

    @property
    def number(self) -> Number:
        return self.case.numbers[self.element]

    @property
    def kind(self) -> Number:
        """The number without its name and unit, which the rules of encoding do not use."""
        return self.number._replace(name="", unit="")


class CommandVariant(NamedTuple):
    """A variant of a message with one case for each of its fields."""

    table: Table
    command: Command
    direction: Direction
    variant: Variant
    frame: bytes
    slots: tuple[Slot, ...]

    def __str__(self) -> str:
        return f"{self.command.name}-{self.direction}-{len(self.variant.fields)}"

    @property
    def name(self) -> str:
        """What tells it from all others."""
        return f"{self.table.edition} {self} {[slot.position for slot in self.slots]}"


def _variants(table: Table) -> Iterator[CommandVariant]:
    for command in table.commands:
        for direction in ("request", "reply"):
            way: Direction = "request" if direction == "request" else "reply"
            for variant in command.variants(way):
                most = max((len(field.cases) for field in variant.fields), default=0)
                for index in range(most):
                    found = _variant(table, command, way, variant, index)
                    if found.slots:
                        yield found


def _variant(
    table: Table, command: Command, way: Direction, variant: Variant, index: int
) -> CommandVariant:
    """Return the variant with case ``index`` of each selected field, and a legal frame of it."""
    data = bytearray(table.frame.header)
    data += bytes([table.frame.length(variant.size), command.id])
    picked = {f.selector: f.cases[index].when[0] for f in variant.fields if f.selector >= 0}
    slots = []
    for number, field in enumerate(variant.fields):
        case = field.cases[index if field.selector >= 0 else 0]
        for element, part in enumerate(case.numbers):
            if part.scaled and part.width == 2:
                slots.append(Slot(number, element, case, len(data)))
            start = field.choices[0] if field.choices else min(max(0, part.minimum), part.maximum)
            start = picked.get(number, start) % 256**part.width
            data += start.to_bytes(part.width, part.order)
    return CommandVariant(
        table, command, way, variant, bytes(data) + table.frame.footer, tuple(slots)
    )


def _narrowed(variant: CommandVariant) -> bool:
    return any(slot.number.maximum - slot.number.minimum + 1 < WORDS for slot in variant.slots)


EVERY = [*_variants(mycobot.TABLE), *_variants(mycobot280.TABLE)]
WIDE = [variant for variant in EVERY if not _narrowed(variant)]
NARROW = [variant for variant in EVERY if _narrowed(variant)]


def _with_new_numbers(variants: list[CommandVariant]) -> Iterator[str]:
    """Yield the first variant for each kind of number: its scale, sign, order and bounds."""
    seen: set[Number] = set()
    for variant in variants:
        numbers = {slot.kind for slot in variant.slots}
        if not numbers <= seen:
            seen |= numbers
            yield variant.name


def _most_alike(variant: CommandVariant) -> int:
    return max(Counter(slot.kind for slot in variant.slots).values())


FIRST = set(_with_new_numbers(EVERY))
# With the most slots of a kind, as these share its values.
SHARING = set(_with_new_numbers(sorted(EVERY, key=_most_alike, reverse=True)))


def test_slots_cover_both_editions_and_directions() -> None:
    places = {(variant.table.edition, variant.direction) for variant in EVERY}
    assert places == {(e, d) for e in ("mycobot", "mycobot280") for d in ("request", "reply")}
    assert {variant.table.edition for variant in NARROW} == {"mycobot", "mycobot280"}


def _codec_of(variant: CommandVariant, codec: Codec) -> Codec:
    return codecs.load(variant.table, codec.name)


@lru_cache
def _nearest(kind: Number) -> list[float]:
    """Return for each raw value the float nearest to its exact quotient."""
    words = (word.to_bytes(2, kind.order) for word in range(WORDS))
    return [kind.unpack(word, 0) * kind.multiply / kind.divide for word in words]


@lru_cache
def _encoded(order: ByteOrder) -> list[bytes]:
    return [word.to_bytes(2, order) for word in range(WORDS)]


def _from(start: int, values: list[T]) -> list[T]:
    """Return what there is for each raw value, with that of ``start`` first."""
    return values[start:] + values[:start]


def _shares(kinds: list[Number]) -> tuple[list[int], int]:
    """Return the first raw value of each slot, and the number of steps.

    The slots of one kind of number share all raw values between them.
    """
    each = {kind: -(-WORDS // kinds.count(kind)) for kind in kinds}
    starts = [kinds[:at].count(kind) * each[kind] for at, kind in enumerate(kinds)]
    return starts, max(each.values())


@pytest.mark.parametrize("variant", WIDE, ids=str)
def test_every_raw_value_of_every_field_survives_decode_and_encode(
    codec: Codec, variant: CommandVariant
) -> None:
    """Run through all raw values; at each step, each slot of the variant has another raw value.

    The reference is slow. A kind of number has all values once, in the variant with most slots of
    this kind, and these share them. Other variants run some, which differ in both bytes.
    """
    codec = _codec_of(variant, codec)
    name, way = variant.command.name, variant.direction
    starts, steps = _shares([slot.kind for slot in variant.slots])
    native = codec.name == "native"
    if native:
        words = slice(WORDS)
    else:
        words = slice(steps) if variant.name in SHARING else slice(0, WORDS, 97)
    # Columns of all steps: to compute each value in its step takes longer than the codec.
    places = [slice(slot.position, slot.position + 2) for slot in variant.slots]
    known = list(zip(starts, variant.slots))
    raws = [_from(start, _encoded(slot.number.order))[words] for start, slot in known]
    nearest = [_from(start, _nearest(slot.kind))[words] for start, slot in known]
    fields = [(s.field, s.element, variant.variant.fields[s.field].many) for s in variant.slots]
    frame = bytearray(variant.frame)
    for encoded, expected in zip(zip(*raws), zip(*nearest)):
        for place, raw in zip(places, encoded):
            frame[place] = raw
        data = bytes(frame)
        values = codec.decode(way, data, of=name).values
        found = [values[at][element] if many else values[at] for at, element, many in fields]
        assert found == list(expected)
        assert codec.encode(name, way, values) == data


@pytest.mark.parametrize("variant", NARROW, ids=str)
def test_raw_value_of_a_limited_field_survives_or_is_rejected(
    variant: CommandVariant,
) -> None:
    """Beyond the limits of the 280, decoding raises an error that names the field and limits."""
    codec = codecs.load(variant.table, "native")
    for slot in variant.slots:
        number = slot.number
        frame = bytearray(variant.frame)
        legal, step = 0, 1 if variant.name in FIRST else 97
        for word in range(0, WORDS, step):
            frame[slot.position : slot.position + 2] = word.to_bytes(2, number.order)
            data = bytes(frame)
            expected = number.minimum <= number.unpack(data, slot.position) <= number.maximum
            # pytest.raises would take most of the time of this test.
            try:
                values = codec.decode(variant.direction, data, of=variant.command.name).values
            except ProtocolError as error:
                rejected = str(error)
            else:
                rejected = ""
            assert (rejected == "") == expected
            if rejected:
                assert variant.variant.fields[slot.field].name in rejected
                continue
            legal += 1
            assert codec.encode(variant.command.name, variant.direction, values) == data
        assert legal > 0
        if step == 1:
            assert legal == number.maximum - number.minimum + 1


@pytest.mark.parametrize("variant", EVERY, ids=str)
def test_value_beyond_the_wire_is_rejected(codec: Codec, variant: CommandVariant) -> None:
    codec = _codec_of(variant, codec)
    for slot in variant.slots:
        number, field = slot.number, variant.variant.fields[slot.field]
        for steps in (number.minimum - 1, number.maximum + 1):
            value = steps * number.multiply / number.divide
            values = list(
                codec.decode(variant.direction, variant.frame, of=variant.command.name).values
            )
            values[slot.field] = value
            if field.many:
                row = [min(max(0, n.minimum), n.maximum) / n.divide for n in slot.case.numbers]
                row[slot.element] = value
                values[slot.field] = row
            with pytest.raises(UsageError, match=field.name) as caught:
                codec.encode(variant.command.name, variant.direction, values)
            assert caught.value.value == value
            assert ".." in caught.value.allowed
