"""Proposes vectors for the variants of messages that no vector shows."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil

from cobotwire_codegen.author.draft import vector_lines
from cobotwire_codegen.check.evidence import unshown
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Command,
    Edition,
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
from cobotwire_codegen.wire import build_frame, encode_value

MOST = 10**12


def proposed(edition: Edition) -> Iterator[list[str]]:
    """Yield the lines of a vector for each variant that no vector shows, in the edition's order.

    The frame is computed, so it proves nothing until a person has compared it with a source.
    """
    taken = {vector.name for vector in edition.vectors}
    for command, direction, variant in unshown(edition):
        name = f"{command.name.replace('_', '-')}-{direction}"
        free = next(n for n in _numbered(name) if n not in taken)
        taken.add(free)
        values = typical_values(edition, command, variant)
        frame = build_frame(edition.frame, command, direction, values)
        yield vector_lines(free, command.name, direction, frame, values)


def _numbered(name: str) -> Iterator[str]:
    yield name
    number = 2
    while True:
        yield f"{name}-{number}"
        number += 1


def typical_values(edition: Edition, command: Command, variant: Variant) -> dict[str, object]:
    """Return legal values of a variant that would show a mistake in the spec.

    Numbers are asymmetric, so that a wrong byte order changes the frame. Fields and elements differ
    from each other where possible, so that swapping two of them changes the frame. A field has the
    same value in request and reply. Lists have three elements if the frame has room.
    """
    # Flags have their own numbering, so that the first one is true.
    names = {
        flag: list(
            dict.fromkeys(f.name for f in command.fields if isinstance(f.type, Flag) == flag)
        )
        for flag in (False, True)
    }
    for length in (3, 2, 1, 0):
        values: dict[str, object] = {}
        for field in sorted(variant, key=lambda field: bool(field.selector)):
            cases = {member.name: type for member, type in field.cases}
            type = cases.get(str(values.get(field.selector)), field.type)
            values[field.name] = _of_field(
                field, type, names[isinstance(field.type, Flag)].index(field.name), length
            )
        types = {field.name: field.type for field in variant}
        for field in variant:
            if field.counts:
                listed = types[field.counts]
                data = encode_value(listed, field.counts, values[field.counts])
                values[field.name] = len(data) // listed.element_size
        found = {field.name: values[field.name] for field in variant}
        if sum(_size(field, found[field.name]) for field in variant) <= edition.frame.maximum_data:
            break
    return found


def _size(field: Field, value: object) -> int:
    return len(encode_value(field.type, "", value)) if field.type.varies else field.type.size


def _of_field(field: Field, type: Type, number: int, length: int) -> object:
    if field.const is not None and not isinstance(type, Value):
        return type.from_raw(field.const)
    return _typical(type, number, length)


def _typical(type: Type, number: int, length: int = 0) -> object:
    """Return a legal value; the values for successive numbers differ."""
    if isinstance(type, Value | Bits):
        return tuple(_typical(item, number + at) for at, (_, item) in enumerate(type.items))
    if isinstance(type, Listed):
        count = min(max(length, type.least), type.most)
        apart = len(type.of.parts) or 1
        return tuple(_typical(type.of, number + apart * at) for at in range(count))
    if isinstance(type, Octets):
        count = min(max(length, type.least), type.most)
        return bytes((0x2B + 0x3D * (number + at)) % 256 for at in range(count)).hex(" ").upper()
    if isinstance(type, Chars):
        # A text that is shorter than its field also shows the padding.
        count = type.most if type.padding is None else max(type.most - 1, 1)
        count = min(count, max(length, type.least - (type.padding is not None)))
        return "".join(chr(ord("a") + (number + at) % 26) for at in range(count))
    if isinstance(type, Flag):
        return number % 2 == 0
    if isinstance(type, Enum):
        # The first member is often 0, which an unwritten byte has too.
        others = type.members[1:] or type.members
        return others[number % len(others)].name
    return _quantity(type, number)


def _quantity(type: Quantity, number: int) -> object:
    # Multiples of the golden section are spread evenly over a range, however many there are.
    share = Fraction(382 * (number + 1) % 1000, 1000)
    if type.choices:
        return type.from_raw(type.choices[int(len(type.choices) * share)])
    if type.wire.is_float:
        return _float(type, number, share)
    lowest, highest = (int(bound) for bound in type.bounds)
    if lowest <= 0 <= highest:
        # A vector states the value as a decimal, which is read as a float: stay in its exact range.
        lowest, highest = max(lowest, -MOST), min(highest, MOST)
    raw = lowest + ceil((highest - lowest) * share) or highest
    data = type.wire.bytes_of(raw)
    asymmetric = data != data[::-1] or raw == highest
    return type.from_raw(raw if asymmetric else raw + 1)


def _float(type: Quantity, number: int, share: Fraction) -> object:
    if type.range is None:
        found = Fraction(123456 + 10101 * number, 10000)
        return -found if number % 2 else found
    lowest, highest = type.ends
    exact = lowest + (highest - lowest) * share
    short = Fraction(f"{float(exact):.4g}")
    return short if lowest <= short <= highest else exact
