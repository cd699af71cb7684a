"""Random values of a spec's types: as the model states them, as YAML, and as the codecs."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

from hypothesis import strategies as st

from cobotwire_codegen.model import (
    Bits,
    Chars,
    Enum,
    Field,
    Flag,
    Listed,
    Octets,
    Quantity,
    Type,
    Value,
    Variant,
)
from cobotwire_codegen.wire import encode_value


def decimal(exact: Fraction) -> Any:
    """Return a number that YAML represents exactly."""
    if exact.denominator == 1:
        return int(exact)
    return float(Decimal(exact.numerator) / Decimal(exact.denominator))


def of_field(field: Field, type: Type) -> st.SearchStrategy[Any]:
    """Draw a legal value of a field; its constant if it has one."""
    if field.const is not None:
        assert not isinstance(type, Value), "a value type has no constant"
        return st.just(type.from_raw(field.const))
    return of_type(type)


def of_type(type: Any) -> st.SearchStrategy[Any]:
    """Draw a legal value as the model states it: numbers are exact, members are names."""
    if isinstance(type, Flag):
        return st.booleans()
    if isinstance(type, Enum):
        return st.sampled_from([member.name for member in type.members])
    if isinstance(type, Quantity):
        return _number(type)
    if isinstance(type, Value | Bits):
        return st.tuples(*(of_type(item) for _, item in type.items))
    least, most = type.sizes
    if isinstance(type, Octets):
        return st.binary(min_size=least, max_size=most).map(lambda data: data.hex(" "))
    if isinstance(type, Chars):
        return _text(type)
    return st.lists(of_type(type.of), min_size=least, max_size=most).map(tuple)


def _text(type: Chars) -> st.SearchStrategy[str]:
    least, most = type.sizes
    letters = {"ascii": "ab z", "latin-1": "aé z", "utf-8": "aé€ z"}[type.encoding]
    short = 0 if type.padding is not None else least
    pad = "" if type.padding is None else chr(type.padding)

    def fitting(text: str) -> str:
        while len(text.encode(type.encoding)) > most:
            text = text[:-1]
        text += "z" * (short - len(text.encode(type.encoding)))
        return text.rstrip(pad) if pad else text

    return st.text(st.sampled_from(letters), max_size=most).map(fitting)


def _number(type: Quantity) -> st.SearchStrategy[Fraction]:
    if type.choices:
        return st.sampled_from(type.choices).map(Fraction)
    if type.wire.is_float:
        # Quarters are floats of both widths, and decimals that YAML represents exactly.
        low, high = (int(end) for end in type.ends)
        return st.integers(max(4 * low, -40_000), min(4 * high, 40_000)).map(
            lambda quarters: Fraction(quarters, 4)
        )
    lowest, highest = (int(bound) for bound in type.bounds)
    return st.integers(lowest, highest).map(lambda steps: steps * type.scale)


def as_yaml(value: Any) -> Any:
    """Return a value as a vector in YAML states it."""
    if isinstance(value, tuple):
        return [as_yaml(item) for item in value]
    return decimal(value) if isinstance(value, Fraction) else value


def as_codec(type: Any, value: Any) -> Any:
    """Return a value of the model as the codecs take and return it."""
    if isinstance(type, Octets):
        return bytes.fromhex(value)
    if isinstance(type, Listed):
        return tuple(as_codec(type.of, item) for item in value)
    if isinstance(type, Value | Bits):
        return tuple(as_codec(item, part) for (_, item), part in zip(type.items, value))
    if isinstance(type, Enum):
        return next(m.value for m in type.members if value in (m.name, m.value))
    return float(value) if isinstance(value, Fraction) and value.denominator != 1 else value


def type_of(field: Field, values: dict[str, Any]) -> Type:
    """Return the type of a field in a message with these values."""
    if not field.selector:
        return field.type
    cases = {member.name: type for member, type in field.cases}
    return cases[str(values[field.selector])]


def counted(variant: Variant, values: dict[str, Any]) -> dict[str, Any]:
    """Return values in the order of the variant, with the counts that they imply."""
    fields = {field.name: field for field in variant}

    def size(listed: Field) -> int:
        data = encode_value(listed.type, listed.name, values[listed.name])
        return len(data) // listed.type.element_size

    return {
        name: Fraction(size(fields[field.counts])) if field.counts else values[name]
        for name, field in fields.items()
    }
