"""Explain why no test can distinguish a codec with a wrong table from a correct one."""

from __future__ import annotations

from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.questions.frames import frame_of
from cobotwire.conformance.codec.questions.our_codec import encode_named, plain_fields
from cobotwire.conformance.samples.physical import named_values
from cobotwire.conformance.samples.raw import RawValues, ordinary, with_one
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Field, Number, Table
from mutation.tables import Place, WrongTable, variant_at

# A number of three bytes or more has too many values to try all, so nothing excuses its mutant.
MOST_VALUES = 65536


def reason(table: Table, mutant: WrongTable) -> str:
    """Return why a wrong table equals the correct one for every raw value; empty if they differ."""
    place = mutant.place
    if place.field < 0:
        return _shadowed(table, place)
    right, wrong = ReferenceCodec(table), ReferenceCodec(mutant.table)
    samples = _all_samples(table, place, variant_at(table, place).fields[place.field])
    if not samples or not all(_alike(table, right, wrong, place, each) for each in samples):
        return ""
    return f"equal results for {len(samples)} raw values: all of the field, and one beyond each end"


def _shadowed(table: Table, place: Place) -> str:
    """Return the reason if another variant has the same fields and size; otherwise nothing."""
    variants = table.command(place.command).variants(place.direction)
    own = variants[place.variant]
    twins = [variant for variant in variants if variant is not own and variant == own]
    return "another variant of the command is equal" if twins else ""


def _all_samples(table: Table, place: Place, field: Field) -> list[RawValues]:
    variant = variant_at(table, place)
    base = ordinary(variant)
    case = variant.raw_case(field, base)
    assert case is not None, "an ordinary selector has a case"
    return [
        with_one(base, place.field, element, raw)
        for element, number in enumerate(case.numbers[:1])
        for raw in _values(number)
    ]


def _values(number: Number) -> range:
    top = 256**number.width
    low, high = number.raw_range
    return range(low - 1, high + 2) if top <= MOST_VALUES else range(0)


def _alike(table: Table, right: Codec, wrong: Codec, place: Place, raw_values: RawValues) -> bool:
    variant = variant_at(table, place)
    values = named_values(variant, raw_values)
    if _encoded(right, place, values) != _encoded(wrong, place, values):
        return False
    data = frame_of(table, table.command(place.command).id, variant.pack(raw_values))
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
