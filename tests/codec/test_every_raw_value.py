"""All 65,536 words of every scaled 16-bit field survive decode and encode, or are refused."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.codec.reference.decode import whole
from cobotwire.editions.mycobot import TABLE
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import Case, Field, Number
from strategies import FORMS, Form


def _slots() -> Iterator[tuple[Form, Field, Case, int]]:
    """Every scaled word of every form: the field, its case, and which number of it."""
    for form in FORMS:
        for field in form.layout.fields:
            for case in field.cases:
                for index, number in enumerate(case.numbers):
                    if number.scaled and number.width == 2:
                        yield form, field, case, index


SLOTS = list(_slots())


def _rule(number: Number) -> Number:
    """What of a number decides how it is read; its name does not."""
    return Number("", *(getattr(number, name) for name in Number.__slots__[1:]))


def _one_a_rule() -> list[tuple[Form, Field, Case, int]]:
    return list({_rule(slot[2].numbers[slot[3]]): slot for slot in SLOTS}.values())


def test_there_are_slots_in_every_direction() -> None:
    assert len(SLOTS) > 60
    assert {slot[0].direction for slot in SLOTS} == {"request", "reply"}


@pytest.mark.parametrize(
    "slot", SLOTS, ids=lambda s: f"{s[0].command.name}-{s[0].direction}-{s[3]}"
)
def test_every_raw_value_of_every_field_on_the_native_codec(
    slot: tuple[Form, Field, Case, int],
) -> None:
    _sweep(codecs.load(TABLE, "native"), *slot)


@pytest.mark.parametrize("slot", _one_a_rule(), ids=lambda s: s[2].numbers[s[3]].unit)
def test_every_raw_value_of_every_rule_on_the_reference(
    slot: tuple[Form, Field, Case, int],
) -> None:
    _sweep(codecs.load(TABLE, "reference"), *slot)


def _sweep(codec: Codec, form: Form, field: Field, case: Case, index: int) -> None:
    number = case.numbers[index]
    frame, position = _template(form, field, case, index)
    column = form.layout.fields.index(field)
    said = refused = 0
    for word in range(65_536):
        frame[position : position + 2] = word.to_bytes(2, number.order)
        data = bytes(frame)
        steps = whole(number, data, position)
        if not number.minimum <= steps <= number.maximum:
            with pytest.raises(ProtocolError, match=field.name):
                codec.decode(form.direction, data)
            refused += 1
            continue
        message = codec.decode(form.direction, data)
        value = message.values[column]
        value = value[index] if field.many else value
        # The float nearest to the exact quotient: division of two whole numbers is exact in that.
        assert value == steps * number.multiply / number.divide
        assert codec.encode(form.command.name, form.direction, message.values) == data
        said += 1
    assert said == number.maximum - number.minimum + 1
    assert said + refused == 65_536


def _template(form: Form, field: Field, case: Case, index: int) -> tuple[bytearray, int]:
    """A legal frame of the form, and where in it the number stands."""
    frame = TABLE.frame
    data = bytearray(frame.header)
    data += bytes([frame.length(form.layout.size), form.command.id])
    position = 0
    for other in form.layout.fields:
        chosen = case if other is field else other.cases[0]
        for order, number in enumerate(chosen.numbers):
            if other is field and order == index:
                position = len(data)
            start = other.choices[0] if other.choices else max(0, number.minimum)
            if form.layout.fields[field.selector] is other and field.selector >= 0:
                start = case.when[0]
            data += start.to_bytes(number.width, number.order)
    return data + frame.footer, position


@pytest.mark.parametrize("slot", _one_a_rule(), ids=lambda s: s[2].numbers[s[3]].unit)
def test_what_the_rule_cannot_say_is_refused(
    codec: Codec, slot: tuple[Form, Field, Case, int]
) -> None:
    form, field, case, index = slot
    number = case.numbers[index]
    frame, _ = _template(form, field, case, index)
    values = list(codec.decode(form.direction, bytes(frame)).values)
    column = form.layout.fields.index(field)
    for steps in (number.minimum - 1, number.maximum + 1):
        value = steps * number.multiply / number.divide
        values[column] = value
        if field.many:
            row = [0.0] * len(case.numbers)
            row[index] = value
            values[column] = row
        with pytest.raises(UsageError, match=field.name) as caught:
            codec.encode(form.command.name, form.direction, values)
        assert caught.value.value == value
        assert ".." in caught.value.allowed
