"""The words of a codec's errors, made once for both codecs from the same few facts.

A codec says *where* and *what kind*; the sentence is made here, so the two cannot drift apart.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import Case, Command, Direction, Field, FrameFormat, Number, Table

ValueFault = Literal["type", "not-finite", "range", "choice", "count"]
FrameFault = Literal[
    "no-header", "bad-address", "bad-length", "unknown-id", "bad-check", "truncated", "trailing"
]


def refuse_direction(given: Any) -> UsageError:
    """A word that is no direction."""
    return UsageError("direction", given, "request or reply")


def refuse_form(command: Command, direction: Direction, given: int) -> UsageError:
    """No form of the message has that many fields."""
    forms = command.layouts(direction)
    if not forms:
        return UsageError(
            f"{command.name} {direction}", given, f"none: it has no framed {direction}"
        )
    allowed = " or ".join(
        "(" + ", ".join(field.name for field in form.fields) + ")" for form in forms
    )
    return UsageError(f"{command.name} {direction}: number of values", given, allowed)


def refuse_address(given: Any, addresses: tuple[int, ...]) -> UsageError:
    """An address byte that the frame format does not have."""
    allowed = f"one of {', '.join(map(str, addresses))}" if addresses else "none in this edition"
    return UsageError("address", given, allowed)


def refuse_value(
    field: Field, case: Case, element: int, fault: ValueFault, value: Any
) -> UsageError:
    """A value that the field does not allow; ``element`` is -1 for the field as a whole."""
    if element < 0:
        if fault == "count":
            # The elements themselves may be long and right: their number is what is wrong.
            return UsageError(f"len({field.name})", len(value), _elements(case))
        return UsageError(
            field.name, value, _elements(case) if field.many else _bounds(field, case.numbers[0])
        )
    number = case.numbers[element]
    name = field.name
    if field.many:
        name += f".{number.name}" if number.name else f"[{element}]"
    return UsageError(name, value, _bounds(field, number))


def refuse_raw(
    command: Command, field: Field, case: Case, element: int, whole: int, offset: int, data: bytes
) -> ProtocolError:
    """A number on the wire that the edition does not allow."""
    number = case.numbers[element]
    detail = (
        f"{command.name}: {field.name} holds {physical(number, whole)}, "
        f"allowed: {_bounds(field, number)}"
    )
    return ProtocolError("bad-value", offset, data, detail)


def refuse_frame(
    table: Table, direction: Direction, fault: FrameFault, offset: int, data: bytes
) -> ProtocolError:
    """Bytes that are not one whole legal frame."""
    return ProtocolError(fault, offset, data, _frame_fault(table, direction, fault, data))


def physical(number: Number, whole: int) -> int | float:
    """What a whole number on the wire stands for."""
    return whole * number.multiply / number.divide if number.scaled else whole


def _frame_fault(table: Table, direction: Direction, fault: FrameFault, data: bytes) -> str:
    frame = table.frame
    at = frame.length_at
    if fault == "no-header":
        return f"a frame starts with {frame.header.hex(' ').upper()}"
    if fault == "bad-address":
        legal = ", ".join(f"{address:02X}" for address in frame.addresses)
        return f"the address {data[at - 1]:02X} is none of {legal}"
    if fault == "truncated":
        if len(data) <= at:
            return "the bytes end before LEN"
        return f"LEN {data[at]:02X} promises {data[at] + frame.overhead - len(data)} more byte(s)"
    if fault == "bad-length":
        return _bad_length(table, direction, data)
    if fault == "unknown-id":
        return f"edition {table.edition} has no {direction} with id {data[at + 1]:02X}"
    if fault == "bad-check":
        return _bad_check(frame)
    return f"LEN {data[at]:02X} ends the frame before the last byte given"


def _bad_check(frame: FrameFormat) -> str:
    if frame.check == "footer":
        return f"a frame ends with {frame.footer.hex().upper()}"
    return "the CRC is wrong" if frame.check == "crc16-modbus" else "the sum is wrong"


def _bad_length(table: Table, direction: Direction, data: bytes) -> str:
    at = table.frame.length_at
    id = data[at + 1] if len(data) > at + 1 else None
    legal = {
        table.frame.length(form.size): command.name
        for command in table.commands
        for form in command.layouts(direction)
        if command.id == id
    }
    if not legal:
        return f"no {direction} of edition {table.edition} has LEN {data[at]:02X}"
    name = next(iter(legal.values()))
    lengths = " or ".join(f"{length:02X}" for length in sorted(legal))
    return f"LEN {data[at]:02X} is not legal for the {direction} {id:02X} ({name}): it is {lengths}"


def _elements(case: Case) -> str:
    names = [number.name for number in case.numbers]
    text = f"a sequence of {len(names)} numbers"
    return f"{text} ({', '.join(names)})" if all(names) else text


def _bounds(field: Field, number: Number) -> str:
    if field.kind == "flag":
        return "True or False"
    if field.choices:
        return "one of " + ", ".join(str(choice) for choice in field.choices)
    kind = "a number" if number.scaled else "a whole number"
    unit = f" {number.unit}" if number.unit else ""
    return f"{kind} {_exact(number, number.minimum)}..{_exact(number, number.maximum)}{unit}"


def _exact(number: Number, whole: int) -> str:
    value = Fraction(whole * number.multiply, number.divide)
    return str(value) if value.denominator == 1 else str(float(value))
