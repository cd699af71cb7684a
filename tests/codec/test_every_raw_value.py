"""All 65,536 words of every scaled 16-bit field survive decode and encode, or are refused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.codec.reference.decode import whole
from cobotwire.editions import mycobot, mycobot280
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import Case, Command, Direction, Layout, Number, Table

WORDS = 65_536


class Slot(NamedTuple):
    """A scaled word of a form, while its selector (if any) holds the case's first value."""

    field: int
    element: int
    case: Case
    position: int

    @property
    def number(self) -> Number:
        return self.case.numbers[self.element]


class Form(NamedTuple):
    """A form of a message with one case for each of its fields."""

    table: Table
    command: Command
    direction: Direction
    layout: Layout
    frame: bytes
    slots: tuple[Slot, ...]

    def __str__(self) -> str:
        return f"{self.command.name}-{self.direction}-{len(self.layout.fields)}"


def _forms(table: Table) -> Iterator[Form]:
    for command in table.commands:
        for direction in ("request", "reply"):
            way: Direction = "request" if direction == "request" else "reply"
            for layout in command.layouts(way):
                most = max((len(field.cases) for field in layout.fields), default=0)
                for index in range(most):
                    form = _form(table, command, way, layout, index)
                    if form.slots:
                        yield form


def _form(table: Table, command: Command, way: Direction, layout: Layout, index: int) -> Form:
    """A legal frame of the form in which each selected field takes its case ``index``."""
    data = bytearray(table.frame.header)
    data += bytes([table.frame.length(layout.size), command.id])
    picked = {f.selector: f.cases[index].when[0] for f in layout.fields if f.selector >= 0}
    slots = []
    for number, field in enumerate(layout.fields):
        case = field.cases[index if field.selector >= 0 else 0]
        for element, part in enumerate(case.numbers):
            if part.scaled and part.width == 2:
                slots.append(Slot(number, element, case, len(data)))
            start = field.choices[0] if field.choices else min(max(0, part.minimum), part.maximum)
            start = picked.get(number, start) % 256**part.width
            data += start.to_bytes(part.width, part.order)
    return Form(table, command, way, layout, bytes(data) + table.frame.footer, tuple(slots))


def _narrowed(form: Form) -> bool:
    return any(slot.number.maximum - slot.number.minimum + 1 < WORDS for slot in form.slots)


EVERY = [*_forms(mycobot.TABLE), *_forms(mycobot280.TABLE)]
WIDE = [form for form in EVERY if not _narrowed(form)]
NARROW = [form for form in EVERY if _narrowed(form)]


def test_there_are_slots_in_both_editions_and_directions() -> None:
    places = {(form.table.edition, form.direction) for form in EVERY}
    assert places == {(e, d) for e in ("mycobot", "mycobot280") for d in ("request", "reply")}
    assert {form.table.edition for form in NARROW} == {"mycobot280"}


def _codec_of(form: Form, codec: Codec) -> Codec:
    return codecs.load(form.table, codec.name)


@pytest.mark.parametrize("form", WIDE, ids=str)
def test_every_word_of_every_field_survives(codec: Codec, form: Form) -> None:
    """One pass over all words: each slot of the form holds another one at the same time."""
    codec = _codec_of(form, codec)
    name, way = form.command.name, form.direction
    step = WORDS // len(form.slots)
    frame = bytearray(form.frame)
    # A native pass is cheap; of the reference's, every edition needs the forms of the first only.
    words = range(0, WORDS, 1 if codec.name == "native" or form.table is mycobot.TABLE else 97)
    for word in words:
        for order, slot in enumerate(form.slots):
            raw = (word + order * step) % WORDS
            frame[slot.position : slot.position + 2] = raw.to_bytes(2, slot.number.order)
        data = bytes(frame)
        values = codec.decode(way, data, of=name).values
        for slot in form.slots:
            number = slot.number
            value = values[slot.field]
            value = value[slot.element] if form.layout.fields[slot.field].many else value
            # The float nearest to the exact quotient.
            assert value == whole(number, data, slot.position) * number.multiply / number.divide
        assert codec.encode(name, way, values) == data


@pytest.mark.parametrize("form", NARROW, ids=str)
def test_every_word_of_a_limited_field_survives_or_is_refused(form: Form) -> None:
    """The limits of the 280: beyond them decoding is an error that names field and limits."""
    codec = codecs.load(form.table, "native")
    for slot in form.slots:
        number = slot.number
        frame = bytearray(form.frame)
        said = 0
        for word in range(WORDS):
            frame[slot.position : slot.position + 2] = word.to_bytes(2, number.order)
            data = bytes(frame)
            if not number.minimum <= whole(number, data, slot.position) <= number.maximum:
                with pytest.raises(ProtocolError, match=form.layout.fields[slot.field].name):
                    codec.decode(form.direction, data, of=form.command.name)
                continue
            values = codec.decode(form.direction, data, of=form.command.name).values
            said += 1
            assert codec.encode(form.command.name, form.direction, values) == data
        assert said == number.maximum - number.minimum + 1


@pytest.mark.parametrize("form", EVERY, ids=str)
def test_what_the_rule_cannot_say_is_refused(codec: Codec, form: Form) -> None:
    codec = _codec_of(form, codec)
    for slot in form.slots:
        number, field = slot.number, form.layout.fields[slot.field]
        for steps in (number.minimum - 1, number.maximum + 1):
            value = steps * number.multiply / number.divide
            values = list(codec.decode(form.direction, form.frame, of=form.command.name).values)
            values[slot.field] = value
            if field.many:
                row = [min(max(0, n.minimum), n.maximum) / n.divide for n in slot.case.numbers]
                row[slot.element] = value
                values[slot.field] = row
            with pytest.raises(UsageError, match=field.name) as caught:
                codec.encode(form.command.name, form.direction, values)
            assert caught.value.value == value
            assert ".." in caught.value.allowed
