"""Codecs with wrong single frames: missing checks, wrong rounding, rows in another order.

Some faults need frames with a check value, or with an address.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json, hexed
from cobotwire.protocol.checks import Check
from cobotwire.protocol.table import Case, Field, Number, Table, Variant
from mutation.device.cells import Edit, with_address, with_length


class Altered(OurCodec):
    """A correct codec with changed questions or answers."""

    def __init__(
        self,
        table: Table,
        question: Callable[[Json], Json] = lambda question: question,
        answer: Callable[[Json, Json], Json] = lambda question, answer: answer,
    ) -> None:
        super().__init__(ReferenceCodec(table))
        self._question, self._altered = question, answer

    def ask(self, question: Json) -> Json:
        """Return the altered answer."""
        return self._altered(question, super().ask(self._question(question)))


Make = Callable[[Table], OurCodec]


def _decoding(change: Edit) -> Make:
    """Make a codec that decodes other bytes than it is given."""

    def decoded(table: Table, question: Json) -> Json:
        if question["do"] != "decode":
            return question
        return {**question, "bytes": change(table, bytes.fromhex(question["bytes"])).hex()}

    return lambda table: Altered(table, partial(decoded, table))


def _rejecting(change: Callable[[Json], Json]) -> Make:
    """Make a codec that reports rejections incorrectly."""

    def rejected(question: Json, answer: Json) -> Json:
        return change(answer) if question["do"] == "decode" and "error" in answer else answer

    return lambda table: Altered(table, answer=rejected)


def _encoding(change: Edit) -> Make:
    """Make a codec that encodes other bytes."""

    def encoded(table: Table, question: Json, answer: Json) -> Json:
        if "bytes" not in answer:
            return answer
        return {"bytes": change(table, bytes.fromhex(answer["bytes"])).hex()}

    return lambda table: Altered(table, answer=partial(encoded, table))


def _right_end(table: Table, data: bytes) -> bytes:
    """Return the bytes with the check and the footer that their LEN calls for."""
    frame = table.frame
    end = frame.overhead + frame.read_length(data) if len(data) > frame.length_at else 0
    body = data[: max(0, end - frame.check_size)]
    if frame.data_at <= len(body) and end <= len(data):
        return body + frame.end(body) + data[end:]
    return data


def _right_header(table: Table, data: bytes) -> bytes:
    return table.frame.header[: len(data)] + data[len(table.frame.header) :]


def _right_length(table: Table, data: bytes) -> bytes:
    at = table.frame.length_at
    if len(data) <= table.frame.overhead:
        return data
    return data[:at] + bytes([len(data) - table.frame.overhead & 0xFF]) + data[at + 1 :]


def _no_rest(table: Table, data: bytes) -> bytes:
    at = table.frame.length_at
    return data[: table.frame.overhead + data[at]] if len(data) > at else data


def _first_header(table: Table, data: bytes) -> bytes:
    at = data.find(table.frame.header)
    return data[at:] if at > 0 else data


def _unnamed(table: Table) -> OurCodec:
    """Make a codec that decodes bytes as any command, although a question names one."""

    def question(question: Json) -> Json:
        if question["do"] != "decode":
            return question
        return {name: value for name, value in question.items() if name != "command"}

    return Altered(table, question)


def _rounding(rounded: Callable[[float], int]) -> Make:
    """Make a codec that rounds in another way than to the nearest step, ties to even."""

    def make(table: Table) -> OurCodec:
        def question(question: Json) -> Json:
            if question["do"] != "encode":
                return question
            steps = _steps(table, question)
            fields = {
                name: _each(value, lambda v, n=name: _stepped(v, steps.get(n), rounded))  # type: ignore[misc]
                for name, value in question["fields"].items()
            }
            return {**question, "fields": fields}

        return Altered(table, question)

    return make


def _steps(table: Table, question: Json) -> dict[str, tuple[int, int]]:
    return {
        field.name: (field.cases[0].numbers[0].multiply, field.cases[0].numbers[0].divide)
        for variant in table.command(question["command"]).variants(question["direction"])
        for field in variant.fields
        if field.cases[0].numbers[0].scaled
        and len({(n.multiply, n.divide) for case in field.cases for n in case.numbers}) == 1
    }


def _stepped(value: Any, step: tuple[int, int] | None, rounded: Callable[[float], int]) -> Any:
    if step is None:
        return value
    multiply, divide = step
    return rounded(value * divide / multiply) * multiply / divide


def _each(value: Any, change: Callable[[Any], Any]) -> Any:
    return [change(part) for part in value] if isinstance(value, list) else change(value)


def _half_up(value: float) -> int:
    return int(value + 0.5) if value >= 0 else -int(-value + 0.5)


def _unbounded(table: Table, lists: bool) -> Table:
    """Return a table with every field open to every value that the wire can carry."""

    def number(n: Number) -> Number:
        low, high = n.raw_range
        return n._replace(minimum=low, maximum=high)

    def field(f: Field) -> Field:
        if bool(f.choices) != lists:
            return f
        cases = tuple(Case(c.when, tuple(map(number, c.numbers))) for c in f.cases)
        kind = "number" if lists else f.kind
        return f._replace(cases=cases, choices=(), labels=(), kind=kind)

    def widened(variants: tuple[Variant, ...]) -> tuple[Variant, ...]:
        return tuple(Variant(tuple(map(field, variant.fields))) for variant in variants)

    commands = (
        c._replace(request=widened(c.request), reply=widened(c.reply)) for c in table.commands
    )
    return table._replace(commands=tuple(commands))


def _shifted(answer: Json) -> Json:
    return {**answer, "offset": answer.get("offset", 0) + 1}


ANSWERS: tuple[tuple[str, Make], ...] = (
    ("ignores check and footer", _decoding(_right_end)),
    ("ignores the header", _decoding(_right_header)),
    ("ignores LEN", _decoding(_right_length)),
    ("ignores bytes after the frame", _decoding(_no_rest)),
    ("searches the bytes for the frame", _decoding(_first_header)),
    ("ignores the command that the bytes must be", _unnamed),
    ("reports the byte after the wrong one", _rejecting(_shifted)),
    ("reports one reason for all", _rejecting(lambda answer: {**answer, "error": "bad-value"})),
    ("truncates numbers to the lower step", _rounding(int)),
    ("rounds ties away from zero", _rounding(_half_up)),
    ("ignores bounds", lambda t: OurCodec(ReferenceCodec(_unbounded(t, lists=False)))),
    ("ignores lists", lambda t: OurCodec(ReferenceCodec(_unbounded(t, lists=True)))),
    ("writes another last byte", _encoding(lambda _, data: data[:-1] + bytes([data[-1] ^ 1]))),
    ("leaves the last byte out", _encoding(lambda _, data: data[:-1])),
    ("counts the header in LEN", _encoding(with_length(2))),
    ("counts a byte too few in LEN", _encoding(with_length(-1))),
    ("writes one header byte", _encoding(lambda _, data: data[1:])),
    ("writes one byte too many", _encoding(lambda _, data: data + data[-1:])),
)


def wrong_formats(table: Table) -> Iterator[tuple[str, Make]]:
    """Yield each fault in the parts of a frame that not every edition has."""
    check, addresses = table.frame.check, table.frame.addresses
    if check is not None:
        other = check._replace(covers_from="data" if check.covers_from == "command" else "command")
        yield "computes the check from another byte on", _with(other)
    if check is not None and check.width > 1:
        other = check._replace(order="little" if check.order == "big" else "big")
        yield "swaps the bytes of the check", _with(other)
    if check is not None and check.crc is not None:
        crc = check.crc._replace(init=check.crc.init ^ 1)
        yield "begins the CRC with another value", _with(check._replace(crc=crc))
    if addresses:
        yield "ignores the address", _decoding(_right_address)
        unused = next(byte for byte in range(256) if byte not in addresses)
        yield "writes an address that the edition lacks", _encoding(with_address(unused))


def _with(check: Check) -> Make:
    """Make a codec with another check."""
    return lambda table: OurCodec(
        ReferenceCodec(table._replace(frame=table.frame._replace(check=check)))
    )


def _right_address(table: Table, data: bytes) -> bytes:
    """Return the bytes with an address of the edition in place of another one."""
    at, addresses = table.frame.address_at, table.frame.addresses
    if at is None or len(data) <= at or data[at] in addresses:
        return data
    return with_address(addresses[0])(table, data)


def turned(table: Table, command: str, direction: str, name: str, first_two: bool) -> OurCodec:
    """Return a codec that reads and writes the elements of a row in another order."""

    def turn(row: Any) -> Any:
        if isinstance(row, str):
            return hexed(bytes(turn(list(bytes.fromhex(row)))))
        if not isinstance(row, list) or len(row) < 2:
            return row
        return [row[1], row[0], *row[2:]] if first_two else row[::-1]

    def here(question: Json) -> bool:
        return question.get("direction") == direction

    def fields(known: Json) -> Json:
        return {n: turn(value) if n == name else value for n, value in known.items()}

    def question(question: Json) -> Json:
        if question["do"] == "encode" and question["command"] == command and here(question):
            return {**question, "fields": fields(question["fields"])}
        return question

    def answer(question: Json, answer: Json) -> Json:
        if question["do"] == "decode" and here(question) and answer.get("command") == command:
            return {**answer, "fields": fields(answer["fields"])}
        return answer

    return Altered(table, question, answer)
