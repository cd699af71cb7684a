"""Builds frames from the model with exact arithmetic: the third, independent encoder.

The codecs interpret the generated table, but this encoder reads the model. So a mistake in lowering
makes a vector fail.
"""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from operator import xor
from typing import Literal

from cobotwire_codegen import floats
from cobotwire_codegen.catalogue import Crc
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Command,
    Enum,
    Field,
    Flag,
    Frame,
    FrameCheck,
    FrameNumber,
    Listed,
    Octets,
    Quantity,
    Type,
    Value,
    Variant,
    Wire,
)


def build_frame(
    frame: Frame,
    command: Command,
    direction: Literal["request", "reply"],
    values: dict[str, object],
    address: int | None = None,
) -> bytes:
    """Return the frame that carries ``values``.

    Raises:
        ValueError: the message has no such variant, or a value cannot be encoded.
    """
    _, data = encode_variant(command, direction, values)
    return enclose(frame, command.id, data, direction, address)


def encode_variant(
    command: Command, direction: Literal["request", "reply"], values: dict[str, object]
) -> tuple[Variant, bytes]:
    """Return the first variant that has these fields and allows their values, and its data bytes.

    Raises:
        ValueError: the message has no such variant, or a value cannot be encoded.
    """
    problem = f"no {direction} of {command.name} has the fields {', '.join(values)}"
    for variant in command.variants(direction):
        if [field.name for field in variant] == list(values):
            try:
                _check_counts(variant, values)
                return variant, b"".join(_field(field, values) for field in variant)
            except ValueError as error:
                problem = str(error)
    raise ValueError(problem)


def enclose(
    frame: Frame,
    id: int,
    data: bytes,
    direction: Literal["request", "reply"] = "request",
    address: int | None = None,
) -> bytes:
    """Return the frame around data bytes. The default address is the first of the frame format.

    Raises:
        ValueError: the id or LEN is too large.
    """
    parts = {
        "address": bytes(frame.address_values[:1] if address is None else [address]),
        "length": _number(frame.length_number, frame.length(len(data), direction)),
        "command": _number(frame.command_number, id) if frame.has_command(direction) else b"",
    }
    body = frame.header + b"".join(parts[part] for part in frame.layout) + data
    return body + check_of(frame, body)


def _number(form: FrameNumber, number: int) -> bytes:
    if number >= 1 << 8 * form.width:
        raise ValueError(f"{number} does not fit into {form.width} byte(s)")
    return number.to_bytes(form.width, form.order)


def check_of(frame: Frame, body: bytes) -> bytes:
    """Return check and footer of a frame, from all bytes before them."""
    if frame.check is None:
        return frame.footer
    number = number_of(frame.check, body[frame.offset(frame.check.covers_from) :])
    return number.to_bytes(frame.check.width, frame.check.order) + frame.footer


def number_of(check: FrameCheck, covered: bytes) -> int:
    """Return the number of a check, straight from its definition."""
    total, size = sum(covered), 1 << 8 * check.width
    if check.crc is not None:
        return remainder(check.crc, covered)
    if check.word == "xor":
        return reduce(xor, covered, 0)
    if check.word in ("fletcher", "fletcher-16"):
        modulus = 256 if check.word == "fletcher" else 255
        second = sum(place * byte for place, byte in enumerate(reversed(covered), 1))
        return second % modulus * 256 + total % modulus
    numbers = {"sum": total, "inverted-sum": -1 - total, "negated-sum": -total}
    return numbers[check.word] % size


def remainder(crc: Crc, data: bytes) -> int:
    """Return a CRC by division of polynomials, bit by bit."""
    register, top = crc.init, 1 << crc.width - 1
    for byte in data:
        for bit in range(8):
            given = byte >> (bit if crc.refin else 7 - bit) & 1
            carry = bool(register & top) != bool(given)
            register = register << 1 & 2 * top - 1
            register ^= crc.poly if carry else 0
    if crc.refout:
        register = sum((register >> bit & 1) << crc.width - 1 - bit for bit in range(crc.width))
    return register ^ crc.xorout


def _field(field: Field, values: dict[str, object]) -> bytes:
    type, value = field.type, values[field.name]
    if field.selector:
        # The checks of the model report a selector that is not a field of the message.
        picked = str(values.get(field.selector))
        type = next((case for member, case in field.cases if member.name == picked), field.type)
    if field.const is not None:
        return _constant(type, field.name, field.const, value)
    return encode_value(type, field.name, value)


def _check_counts(variant: Variant, values: dict[str, object]) -> None:
    """Raise an error if a field does not hold the number of elements that it counts."""
    fields = {field.name: field for field in variant}
    for field in variant:
        if field.counts:
            listed = fields[field.counts]
            data = encode_value(listed.type, listed.name, values[listed.name])
            size = len(data) // listed.type.element_size
            if values[field.name] != size:
                message = f"{field.name} is {values[field.name]}, but {listed.name} has {size}"
                raise ValueError(f"{message} elements")


def _constant(type: Type, name: str, const: int, value: object) -> bytes:
    """Return the bytes of a constant; a vector states its value, or the number of a member."""
    assert not isinstance(type, Value), "a value type has no constant"
    written = [type.from_raw(const)]
    if not isinstance(type, Quantity):
        written.append(const)
    if value not in written:
        raise ValueError(f"{name} is always {written[0]}")
    return type.wire.bytes_of(const)


def encode_value(type: Type, name: str, value: object) -> bytes:
    """Return one value of a type as bytes."""
    if isinstance(type, Value):
        if not isinstance(value, tuple) or len(value) != len(type.items):
            raise ValueError(f"{name} must be a list of {len(type.items)} numbers")
        return b"".join(
            encode_value(item, f"{name}.{label}", part)
            for (label, item), part in zip(type.items, value)
        )
    if isinstance(type, Bits | Octets | Chars | Listed):
        return encode_shape(type, name, value)
    if isinstance(type, Enum):
        for member in type.members:
            if member.name == value:
                return _word(type.wire, Fraction(member.value), name)
        raise ValueError(f"{name} must be one of {', '.join(m.name for m in type.members)}")
    if isinstance(type, Flag):
        if not isinstance(value, bool):
            raise ValueError(f"{name} must be true or false")
        return _word(type.wire, Fraction(int(value)), name)
    return _quantity(type, name, value)


def encode_shape(type: Bits | Octets | Chars | Listed, name: str, value: object) -> bytes:
    """Return bits, bytes, a text or a list as bytes."""
    if isinstance(type, Bits):
        return _bits(type, name, value)
    if isinstance(type, Octets):
        try:
            data = bytes.fromhex(value if isinstance(value, str) else "-")
        except ValueError:
            raise ValueError(f"{name} must be pairs of hex digits in quotes") from None
        return _sized(type, name, data)
    if isinstance(type, Chars):
        return _chars(type, name, value)
    if not isinstance(value, tuple) or not type.least <= len(value) <= type.most:
        raise ValueError(f"{name} must be a list of {type.least}..{type.most} elements")
    parts = [encode_value(type.of, f"{name}[{i}]", part) for i, part in enumerate(value)]
    return b"".join(parts)


def _sized(type: Octets | Chars, name: str, data: bytes) -> bytes:
    if not type.least <= len(data) <= type.most:
        raise ValueError(f"{name} has {len(data)} bytes; allowed: {type.least}..{type.most}")
    return data


def _chars(type: Chars, name: str, value: object) -> bytes:
    if not isinstance(value, str):
        raise ValueError(f"{name} must be a text")
    try:
        data = value.encode(type.encoding)
    except UnicodeEncodeError:
        raise ValueError(f"{name} is not a text in {type.encoding}") from None
    if type.padding is None:
        return _sized(type, name, data)
    if data.endswith(bytes([type.padding])):
        raise ValueError(f"{name} ends with the padding byte, which decoders remove")
    return _sized(type, name, data.ljust(type.least, bytes([type.padding])))


def _bits(type: Bits, name: str, value: object) -> bytes:
    if not isinstance(value, tuple) or len(value) != len(type.bit_parts):
        raise ValueError(f"{name} must be a list of {len(type.bit_parts)} values")
    word = 0
    for part, each in zip(type.bit_parts, value):
        data = encode_value(part.type, f"{name}.{part.name}", each)
        low = int.from_bytes(data, type.wire.order) & ((1 << part.count) - 1)
        word |= low << part.shift
    return word.to_bytes(type.wire.width, type.wire.order)


def raw_values(type: Type, name: str, value: object) -> tuple[int, ...]:
    """Return the raw values of a value that a type allows; a member may be stated as a number.

    Raises:
        ValueError: the type does not allow the value.
    """
    if isinstance(type, Enum):
        value = next((m.name for m in type.members if value in (m.name, m.value)), value)
    data = encode_value(type, name, value)
    found = []
    for _, part in type.parts:
        found.append(part.wire.raw_of(data[: part.size]))
        data = data[part.size :]
    return tuple(found)


def _quantity(type: Quantity, name: str, value: object) -> bytes:
    if isinstance(value, bool) or not isinstance(value, int | Fraction):
        raise ValueError(f"{name} must be a number")
    if type.wire.is_float:
        return _float(type, name, Fraction(value))
    raw = Fraction(value) / type.scale
    if type.choices and raw not in type.choices:
        raise ValueError(f"{name} is {value}; allowed: {', '.join(map(str, type.choices))}")
    lowest, highest = type.bounds
    if not lowest <= raw <= highest:
        raise ValueError(
            f"{name} is {value}; allowed: {lowest * type.scale}..{highest * type.scale}"
        )
    return _word(type.wire, raw, name)


def _float(type: Quantity, name: str, value: Fraction) -> bytes:
    wire, (lowest, highest) = type.wire, type.ends
    rank = floats.nearest(value, wire.width)
    # A decimal at an end of the range may round to the float beyond it.
    if not lowest <= value <= highest or abs(rank) > floats.largest_rank(wire.width):
        raise ValueError(f"{name} is {value}; allowed: {float(lowest):g}..{float(highest):g}")
    return wire.bytes_of(rank)


def _word(wire: Wire, raw: Fraction, name: str) -> bytes:
    if raw.denominator != 1:
        raise ValueError(f"{name} is not a multiple of its scale")
    return wire.bytes_of(int(raw))


def size(type: Type) -> int:
    """Return the number of bytes of a type on the wire; the least one if it varies."""
    return type.size
