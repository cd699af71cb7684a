"""Write the error texts of both codecs.

A codec reports only the kind and the position of an error. This module alone writes the text, so
both codecs have the same texts.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, Literal

from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.fields import Case, Field
from cobotwire.protocol.frame_format import FrameFormat, Unsigned
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.table import Command, Direction, Table

ValueFault = Literal["type", "range", "choice", "count", "element-type", "element-count", "text"]
FrameFault = Literal[
    "no-header", "bad-address", "bad-length", "unknown-id", "bad-check", "truncated", "trailing"
]


def reject_direction(given: Any) -> UsageError:
    """Return the error for a word that is not a direction."""
    return UsageError("direction", given, error_text("direction"))


def reject_variant(command: Command, direction: Direction, given: int) -> UsageError:
    """Return the error for a number of values that no variant of the message has."""
    argument = f"{command.name} {direction}"
    variants = command.variants(direction)
    if not variants:
        message = error_text("no-message", command=command.name, direction=direction)
        return UsageError(argument, given, message=message)
    allowed = error_text("or").join(
        [f"({', '.join([field.name for field in variant.fields])})" for variant in variants]
    )
    kind = "value-count" if given == 1 else "values-count"
    message = error_text(kind, count=given, message=argument, allowed=allowed)
    return UsageError(argument, given, allowed, message=message)


def reject_address(given: Any, addresses: tuple[int, ...]) -> UsageError:
    """Return the error for an address byte that the frame format does not have."""
    return UsageError("address", given, _runs(addresses, "{}") or error_text("no-address"))


def reject_shared(what: str) -> UsageError:
    """Return the error for an object that another thread uses at the same time."""
    return UsageError(what.replace(" ", "_"), message=error_text("shared", what=what))


def reject_offset(given: Any) -> UsageError:
    """Return the error for an offset at which no segment of a stream can begin."""
    return UsageError("offset", given, error_text("offset"))


def reject_workers(given: Any) -> UsageError:
    """Return the error for a number of threads that cannot read a stream."""
    return UsageError("workers", given, error_text("workers"))


def reject_value(
    field: Field, case: Case, element: int, fault: ValueFault, value: Any
) -> UsageError:
    """Return the error for a value that the field does not allow.

    ``element`` is the index in a row of numbers; -1 is the field as a whole. The fault of an
    element of a list has the index of its first number.
    """
    if field.kind == "text":
        each = field.each or len(case.numbers)
        name = field.name if element < 0 else f"{field.name}[{element // each}]"
        if element < 0 and field.each and fault == "count":
            return UsageError(f"len({field.name})", len(value), _sizes(field, case))
        if fault == "count" and field.sizes and not field.each:
            return UsageError(
                f"len({field.name})", len(value.encode(field.encoding)), _sizes(field, case)
            )
        listed = element < 0 and field.each
        return UsageError(name, value, error_text("texts") if listed else _text(field, each))
    if field.counts and fault == "choice":
        return UsageError(f"len({field.counts})", value, _sizes(field, case))
    if fault == "count" and (field.sizes or field.each or field.kind == "bytes"):
        return UsageError(f"len({field.name})", len(value), _sizes(field, case))
    if fault in ("element-type", "element-count"):
        group = Case((), case.numbers[: field.each])
        name = f"{field.name}[{element // field.each}]"
        return UsageError(name, value, _elements(group))
    if element < 0 and field.kind == "bytes":
        return UsageError(field.name, value, error_text("bytes"))
    if element < 0 and field.each:
        return UsageError(field.name, value, error_text("list", sizes=_sizes(field, case)))
    if element < 0:
        if fault == "count":
            # The elements may all be legal; only their number is wrong.
            return UsageError(f"len({field.name})", len(value), _elements(case))
        allowed = _elements(case) if field.many else _allowed(field, case.numbers[0])
        return UsageError(field.name, value, allowed)
    number = case.numbers[element]
    return UsageError(element_name(field, number, element), value, _allowed(field, number))


def reject_radians(error: UsageError, field: Field, given: Any) -> UsageError:
    """Return the error for a value that the caller gave in radians, and the wire has in degrees.

    ``error`` is the codec's, about the field in degrees; ``given`` is what the caller gave.
    """
    elements = {
        element_name(field, number, at): at for at, number in enumerate(field.cases[0].numbers)
    }
    at = elements.get(error.argument)
    if at is None:
        # The error is about the row as a whole, or about its length.
        whole = error.argument == field.name
        return UsageError(field.name, given, error.allowed) if whole else error
    number = field.cases[0].numbers[at]
    bounds = number.physical(number.minimum), number.physical(number.maximum)
    # Rounded inwards, so that the bounds themselves are allowed.
    low, high = (f"{math.trunc(math.radians(bound) * 1e4) / 1e4:g}" for bound in bounds)
    value = list(given)[at] if field.many else given
    return UsageError(error.argument, value, error_text("radians", low=low, high=high))


def reject_raw(
    command: Command, field: Field, case: Case, element: int, raw: int, offset: int, data: bytes
) -> ProtocolError:
    """Return the error for a raw value on the wire that the edition does not allow."""
    number = case.numbers[element]
    whole = field.kind == "text" or not (field.each or number.bits)
    detail = error_text(
        "bad-byte" if field.kind == "text" else "bad-value",
        command=command.name,
        name=field.name if whole else element_name(field, number, element),
        value=number.physical(raw),
        allowed=_allowed(field, number),
        at=element,
        raw=f"{raw:02X}",
        encoding=field.encoding,
    )
    return ProtocolError("bad-value", offset, data, detail)


def reject_frame(
    table: Table, direction: Direction, fault: FrameFault, offset: int, data: bytes
) -> ProtocolError:
    """Return the error for bytes that are not exactly one legal frame."""
    return ProtocolError(fault, offset, data, _frame_fault(table, direction, fault, data))


def _frame_fault(table: Table, direction: Direction, fault: FrameFault, data: bytes) -> str:
    frame = table.frame
    if fault == "no-header":
        return error_text("no-header", header=frame.header.hex(" ").upper())
    if fault == "bad-address":
        allowed = _runs(frame.addresses, "{:02X}")
        return error_text("bad-address", address=f"{frame.address(data):02X}", allowed=allowed)
    if fault == "truncated":
        return _truncated(frame, data)
    if fault == "bad-length":
        return _bad_length(table, direction, data)
    if fault == "unknown-id":
        id = _digits(frame.read_id(data), frame.id_number)
        return error_text("unknown-id", edition=table.edition, direction=direction, id=id)
    if fault == "bad-check":
        return _bad_check(frame)
    length = _digits(frame.read_length(data), frame.length_number)
    return error_text("trailing", length=length)


def _truncated(frame: FrameFormat, data: bytes) -> str:
    if len(data) < frame.length_at + frame.length_number.width:
        return error_text("no-len")
    length = frame.read_length(data)
    missing = length + frame.overhead - len(data)
    kind = "truncated-by-one" if missing == 1 else "truncated"
    return error_text(kind, length=_digits(length, frame.length_number), missing=missing)


def _digits(number: int, form: Unsigned) -> str:
    return f"{number:0{2 * form.width}X}"


def _runs(numbers: tuple[int, ...], digits: str) -> str:
    runs = [(digits.format(first), digits.format(last)) for first, last in ranges(numbers)]
    return ", ".join([a if a == b else error_text("range", low=a, high=b) for a, b in runs])


def ranges(numbers: tuple[int, ...]) -> list[tuple[int, int]]:
    """Return the first and last of each run of consecutive numbers; up to three stay single."""
    found: list[tuple[int, int]] = []
    for number in numbers:
        if found and number == found[-1][1] + 1:
            found[-1] = found[-1][0], number
        else:
            found.append((number, number))
    return [
        pair
        for first, last in found
        for pair in (
            [(first, last)] if last - first > 2 else [(n, n) for n in range(first, last + 1)]
        )
    ]


def _bad_check(frame: FrameFormat) -> str:
    if frame.check is None:
        return error_text("no-footer", footer=frame.footer.hex().upper())
    wrong = {"crc": "bad-crc", "sum": "bad-sum"}
    return error_text(wrong.get(frame.check.algorithm, "bad-check"))


def _bad_length(table: Table, direction: Direction, data: bytes) -> str:
    frame = table.frame
    length = _digits(frame.read_length(data), frame.length_number)
    has_id = frame.has_id(direction)
    come = len(data) >= frame.head_size
    id = frame.read_id(data) if come else None
    commands = [command for command in table.commands if command.id == id or (come and not has_id)]
    legal = {
        frame.length(variant.size, direction)
        for command in commands
        for variant in command.variants(direction)
    }
    if not legal:
        edition = table.edition
        return error_text("no-length", direction=direction, edition=edition, length=length)
    either, what = error_text("or"), str(direction)
    if id is not None and has_id:
        # Commands that share an id are all named: the frame does not tell which one was called.
        names = either.join([command.name for command in commands if command.variants(direction)])
        id_text = _digits(id, frame.id_number)
        what = error_text("identified", direction=direction, id=id_text, names=names)
    lengths = either.join([_digits(each, frame.length_number) for each in sorted(legal)])
    return error_text("bad-length", message=what, length=length, allowed=lengths)


def element_name(field: Field, number: Number, at: int) -> str:
    """Return the name of a number of a field in a text."""
    if not field.many:
        return field.name
    if field.each:
        return f"{field.name}[{at // field.each}].{number.name}"
    return f"{field.name}.{number.name}" if number.name else f"{field.name}[{at}]"


def _sizes(field: Field, case: Case) -> str:
    """Return how many elements a list may have."""
    if field.sizes is None:
        return str(len(case.numbers) // (field.each or 1))
    least, most = field.sizes
    return error_text("range", low=least, high=most) if least < most else str(most)


def _text(field: Field, size: int) -> str:
    """Return what a text may be."""
    name = {"ascii": "ASCII", "utf-8": "UTF-8", "latin-1": "Latin-1"}[field.encoding]
    if field.sizes and not field.each:
        sizes = error_text("range", low=field.sizes[0], high=field.sizes[1])
        return error_text("text-of-sizes", encoding=name, sizes=sizes)
    kind = "text" if field.padding < 0 else "padded-text"
    return error_text(kind, encoding=name, size=size, padding=f"{field.padding:02X}")


def _elements(case: Case) -> str:
    names = [number.name for number in case.numbers]
    kind = "named-row" if all(names) else "row"
    return error_text(kind, count=len(names), names=", ".join(names))


def _allowed(field: Field, number: Number) -> str:
    if "flag" in (field.kind, number.kind):
        return error_text("flag")
    labelled = number if number.labels else field
    if labelled.labels:
        pairs = zip(labelled.labels, labelled.choices)
        return ", ".join([error_text("label", label=label, raw=raw) for label, raw in pairs])
    if choices := field.choices or number.choices:
        return ", ".join(map(str, choices))
    is_float = number.encoding == "float"
    all_finite = is_float and (number.minimum, number.maximum) == number.raw_range
    kind = "any-float" if number.takes_not_finite else "finite" if all_finite else ""
    return error_text(
        f"{kind or ('real' if number.real else 'whole')}{'-with-unit' * bool(number.unit)}",
        low=_bound(number, number.minimum),
        high=_bound(number, number.maximum),
        width=number.width,
        unit=number.units,
    )


@lru_cache(maxsize=1000)  # a stream of wrong values has few bounds, and a fraction takes long
def _bound(number: Number, raw: int) -> str:
    if number.encoding == "float":
        # The nearest float to a decimal has more digits than anyone wrote; -0.0 is written as 0.
        return f"{number.physical(raw) + 0.0:.{6 if number.width == 4 else 15}g}"
    whole, rest = divmod(raw * number.multiply, number.divide)
    return str(number.physical(raw) if rest else whole)
