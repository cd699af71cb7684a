"""Why nobody could tell a codec with a wrong table from the right one; empty if somebody could."""

from __future__ import annotations

from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.named import encode_named, plain_fields
from cobotwire.conformance.codec.trials.frames import frame_of
from cobotwire.conformance.codec.trials.pictures import (
    Wholes,
    case_of,
    named_values,
    ordinary,
    wire_data,
    with_one,
)
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import Field, Number, Table
from mutation.codec.mutant import CodecMutant
from mutation.tables import Place, layout_at

# A word of three bytes or more is too much to go through.
MOST_WORDS = 65536


def reason(table: Table, mutant: CodecMutant) -> str:
    """Goes through every number that the field can carry, both ways."""
    place = mutant.place
    if place is None or mutant.table is None:
        return ""
    if place.field < 0:
        return _shadowed(table, place)
    right, wrong = ReferenceCodec(table), ReferenceCodec(mutant.table)
    field = layout_at(table, place).fields[place.field]
    count = 0
    for wholes in _all_pictures(table, place, field):
        count += 1
        if not _alike(table, right, wrong, place, wholes):
            return ""
    return f"alike for each of the {count} words that it can carry, and one more each way"


def _shadowed(table: Table, place: Place) -> str:
    """A form that another one with the same fields and size stands for."""
    forms = table.command(place.command).layouts(place.direction)
    own = forms[place.form]
    twins = [form for form in forms if form is not own and form == own]
    return "another form of the command is the same" if twins else ""


def _all_pictures(table: Table, place: Place, field: Field) -> list[Wholes]:
    layout = layout_at(table, place)
    base = ordinary(layout)
    case = case_of(layout, field, base)
    assert case is not None, "an ordinary selector has a case"
    return [
        with_one(base, place.field, element, whole)
        for element, number in enumerate(case.numbers[:1])
        for whole in _words(number)
    ]


def _words(number: Number) -> range:
    top = 256**number.width
    low = 0 if number.signed_at == top - 1 else number.signed_at + 1 - top
    return range(low - 1, number.signed_at + 2) if top <= MOST_WORDS else range(0)


def _alike(table: Table, right: Codec, wrong: Codec, place: Place, wholes: Wholes) -> bool:
    layout = layout_at(table, place)
    values = named_values(layout, wholes)
    if _encoded(right, place, values) != _encoded(wrong, place, values):
        return False
    data = frame_of(table, table.command(place.command).id, wire_data(layout, wholes))
    return bool(_decoded(right, place, data) == _decoded(wrong, place, data))


def _encoded(codec: Codec, place: Place, values: dict[str, Any]) -> bytes | None:
    try:
        return encode_named(codec, place.command, place.direction, values)
    except UsageError:
        return None


def _decoded(codec: Codec, place: Place, data: bytes) -> Any:
    try:
        message = codec.decode(place.direction, data, of=place.command)
    except ProtocolError as error:
        return error.reason, error.offset
    return message.command.name, plain_fields(message)
