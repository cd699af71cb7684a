"""Carries the vectors of a base over to a delta.

A vector of the base remains evidence in the delta. If the delta changed only the frame format,
ids, ranges or the number of joints, the vector's frame is derived again, and the vector records
what it was derived from. Any other change (another scale, another field) needs a person, so the
vector stays as it is and the checks report it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from cobotwire_codegen.model import (
    Command,
    Derivation,
    Edition,
    Field,
    Frame,
    Quantity,
    Scalar,
    Type,
    Value,
    Variant,
    Vector,
)
from cobotwire_codegen.wire import enclose, encode_value, encode_variant

Values = tuple[tuple[str, object], ...]


class Underivable(Exception):
    """A change beyond frame format, ids, ranges and the number of joints."""


def carried(
    vector: Vector, name: str, base: Edition, frame: Frame, commands: Mapping[str, Command]
) -> Vector:
    """Return a vector of the base as a vector of the delta.

    Args:
        vector: the vector of the base.
        name: the delta's name for the vector's command.
        base: the edition that has the vector.
        frame: the frame format of the delta.
        commands: the commands of the delta, by name.
    """
    own = replace(vector, command=name, accepted=(), refused=())
    before = base.by_name.get(vector.command)
    after = commands.get(name)
    if vector.frame is None or before is None or after is None:
        return own
    same = _unchanged(vector, before, after)
    own = replace(
        own,
        accepted=tuple(limit for limit in vector.accepted if limit[0] in same),
        refused=tuple(limit for limit in vector.refused if limit[0] in same),
    )
    try:
        values, data = _adapted(vector, before, after)
        address = base.frame.address_in(vector.frame)
        kept = address if address in frame.address_values else None
        built = enclose(frame, after.id, data, vector.direction, kept)
    except (ValueError, Underivable):
        return own
    if built == vector.frame:
        return own
    origin = vector.derived or Derivation(base.name, vector.frame, vector.values)
    # Only the base's document states whether its printed bytes are a legal frame.
    return replace(own, frame=built, values=values, derived=origin, rejected=None)


def _unchanged(vector: Vector, before: Command, after: Command) -> set[str]:
    """Return the fields of a vector's message that have the same types in the delta."""
    types = [
        {(field.name, field.type, field.cases) for v in c.variants(vector.direction) for field in v}
        for c in (before, after)
    ]
    return {name for name, *_ in types[0] & types[1]} - {name for name, *_ in types[0] ^ types[1]}


def _adapted(vector: Vector, before: Command, after: Command) -> tuple[Values, bytes]:
    """Return the values that the delta allows, and their data bytes.

    Raises:
        Underivable: the same values have other bytes in the delta.
        ValueError: the delta's message cannot carry the values.
    """
    given = dict(vector.values)
    old, old_data = encode_variant(before, vector.direction, given)
    try:
        new, data = encode_variant(after, vector.direction, given)
    except ValueError:
        new = next(_with_names(after.variants(vector.direction), list(given)))
    else:
        if data != old_data:
            raise Underivable
        return vector.values, data
    adapted: dict[str, object] = {}
    for one, other in zip(old, new):
        types = _type(one, given), _type(other, given | adapted)
        adapted[other.name] = _value(*types, given[other.name], other.const is not None)
    return tuple(adapted.items()), encode_variant(after, vector.direction, adapted)[1]


def _with_names(variants: tuple[Variant, ...], names: list[str]) -> Iterator[Variant]:
    yield from (variant for variant in variants if [field.name for field in variant] == names)
    raise Underivable


def _type(field: Field, values: Mapping[str, object]) -> Type:
    """Return the type of a field in a message with these values."""
    if not field.selector:
        return field.type
    picked = str(values.get(field.selector))
    return next((type for member, type in field.cases if member.name == picked), field.type)


def _value(old: Type, new: Type, value: object, constant: bool) -> object:
    """Return the value that is nearest to ``value`` among those of the new type."""
    if constant or old == new:
        return value
    if isinstance(old, Value) and isinstance(new, Value) and isinstance(value, tuple):
        former = dict(zip((name for name, _ in old.items), value))
        types = dict(old.items)
        return tuple(
            _nearest(types.get(name, item), item, former.get(name, 0)) for name, item in new.items
        )
    if isinstance(old, Quantity) and isinstance(new, Quantity):
        return _nearest(old, new, value)
    return value


def _nearest(old: Scalar, new: Quantity, value: object) -> object:
    """Return the legal value of the new quantity that is nearest to a value of the old type."""
    if _same_bytes(old, new, value):
        return value
    number = value if isinstance(value, int | Fraction) else None
    if not isinstance(old, Quantity) or number is None or _encoding(old) != _encoding(new):
        raise Underivable
    if new.choices:
        return new.from_raw(min(new.choices, key=lambda raw: abs(raw * new.scale - number)))
    lowest, highest = (bound * new.scale for bound in new.bounds)
    inside = min(max(Fraction(number), lowest), highest)
    return int(inside) if inside.denominator == 1 else inside


def _same_bytes(old: Scalar, new: Quantity, value: object) -> bool:
    try:
        return encode_value(old, "", value) == encode_value(new, "", value)
    except ValueError:
        return False


def _encoding(quantity: Quantity) -> tuple[object, ...]:
    wire = quantity.wire
    return wire.width, wire.order, wire.signed_at, quantity.scale
