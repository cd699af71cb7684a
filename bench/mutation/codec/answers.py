"""Codecs whose single frames are wrong: checks left out, rounding, rows in another order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.adapter.ours import OurCodec
from cobotwire.conformance.codec.trials import Json
from cobotwire.table import Case, Field, Layout, Number, Table


class Altered(OurCodec):
    """A right codec with its questions, or its answers, changed on the way."""

    def __init__(
        self,
        table: Table,
        question: Callable[[Json], Json] = lambda question: question,
        answer: Callable[[Json, Json], Json] = lambda question, answer: answer,
    ) -> None:
        super().__init__(ReferenceCodec(table))
        self._question, self._altered = question, answer

    def ask(self, question: Json) -> Json:
        """The answer, altered."""
        return self._altered(question, super().ask(self._question(question)))


Make = Callable[[Table], OurCodec]


def _decoding(change: Callable[[Table, bytes], bytes]) -> Make:
    """Looks at other bytes than it was given."""

    def make(table: Table) -> OurCodec:
        def question(asked: Json) -> Json:
            if asked["do"] != "decode":
                return asked
            data = bytes.fromhex(asked["bytes"])
            return {**asked, "bytes": change(table, data).hex()}

        return Altered(table, question)

    return make


def _refusing(change: Callable[[Json], Json]) -> Make:
    """Tells refusals of bytes otherwise."""

    def make(table: Table) -> OurCodec:
        def answer(asked: Json, said: Json) -> Json:
            return change(said) if asked["do"] == "decode" and "error" in said else said

        return Altered(table, answer=answer)

    return make


def _encoding(change: Callable[[bytes], bytes]) -> Make:
    """Builds other bytes."""

    def make(table: Table) -> OurCodec:
        def answer(asked: Json, said: Json) -> Json:
            if "bytes" not in said:
                return said
            return {"bytes": change(bytes.fromhex(said["bytes"])).hex()}

        return Altered(table, answer=answer)

    return make


def _right_footer(table: Table, data: bytes) -> bytes:
    at = table.frame.length_at
    end = table.frame.overhead + data[at] if len(data) > at else 0
    if 0 < end <= len(data) and table.frame.check == "footer":
        return data[: end - 1] + table.frame.footer + data[end:]
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
    """Does not look at the command that it must be."""

    def question(asked: Json) -> Json:
        if asked["do"] != "decode":
            return asked
        return {name: value for name, value in asked.items() if name != "command"}

    return Altered(table, question)


def _rounding(rounded: Callable[[float], int]) -> Make:
    """Rounds otherwise than to the nearest step, ties to even."""

    def make(table: Table) -> OurCodec:
        def question(asked: Json) -> Json:
            if asked["do"] != "encode":
                return asked
            steps = _steps(table, asked)
            fields = {
                name: _each(value, lambda v, n=name: _stepped(v, steps.get(n), rounded))  # type: ignore[misc]
                for name, value in asked["fields"].items()
            }
            return {**asked, "fields": fields}

        return Altered(table, question)

    return make


def _steps(table: Table, asked: Json) -> dict[str, tuple[int, int]]:
    return {
        field.name: (field.cases[0].numbers[0].multiply, field.cases[0].numbers[0].divide)
        for layout in table.command(asked["command"]).layouts(asked["direction"])
        for field in layout.fields
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
    """All that the wire can carry, in every field."""

    def number(n: Number) -> Number:
        top = 256**n.width
        low = 0 if n.signed_at == top - 1 else n.signed_at + 1 - top
        return replace(n, minimum=low, maximum=n.signed_at)

    def field(f: Field) -> Field:
        if bool(f.choices) != lists:
            return f
        cases = tuple(Case(c.when, tuple(map(number, c.numbers))) for c in f.cases)
        kind = "number" if lists else f.kind
        return replace(f, cases=cases, choices=(), labels=(), kind=kind)

    def layouts(forms: tuple[Layout, ...]) -> tuple[Layout, ...]:
        return tuple(Layout(tuple(map(field, form.fields))) for form in forms)

    commands = (
        replace(c, request=layouts(c.request), reply=layouts(c.reply)) for c in table.commands
    )
    return replace(table, commands=tuple(commands))


def _shifted(said: Json) -> Json:
    return {**said, "offset": said.get("offset", 0) + 1}


ANSWERS: tuple[tuple[str, Make], ...] = (
    ("does not look at the footer", _decoding(_right_footer)),
    ("does not look at the header", _decoding(_right_header)),
    ("does not look at LEN", _decoding(_right_length)),
    ("does not mind bytes behind the frame", _decoding(_no_rest)),
    ("looks for the frame among the bytes", _decoding(_first_header)),
    ("does not look at the command that it must be", _unnamed),
    ("tells the byte behind the wrong one", _refusing(_shifted)),
    ("tells one reason for all", _refusing(lambda said: {**said, "error": "bad-value"})),
    ("cuts numbers off below the step", _rounding(int)),
    ("rounds ties away from zero", _rounding(_half_up)),
    ("does not look at bounds", lambda t: OurCodec(ReferenceCodec(_unbounded(t, lists=False)))),
    ("does not look at lists", lambda t: OurCodec(ReferenceCodec(_unbounded(t, lists=True)))),
    ("writes another footer", _encoding(lambda data: data[:-1] + b"\xfb")),
    ("leaves the footer out", _encoding(lambda data: data[:-1])),
    ("counts the header in LEN", _encoding(lambda d: d[:2] + bytes([d[2] + 2]) + d[3:])),
    ("does not count the footer in LEN", _encoding(lambda d: d[:2] + bytes([d[2] - 1]) + d[3:])),
    ("writes one header byte", _encoding(lambda data: data[1:])),
    ("writes a byte too many", _encoding(lambda data: data + data[-1:])),
)


def turned(table: Table, command: str, direction: str, name: str, first_two: bool) -> OurCodec:
    """A codec that has the elements of a row in another order."""

    def turn(row: Any) -> Any:
        if not isinstance(row, list):
            return row
        return [row[1], row[0], *row[2:]] if first_two else row[::-1]

    def here(asked: Json) -> bool:
        return asked.get("direction") == direction

    def fields(known: Json) -> Json:
        return {n: turn(value) if n == name else value for n, value in known.items()}

    def question(asked: Json) -> Json:
        if asked["do"] == "encode" and asked["command"] == command and here(asked):
            return {**asked, "fields": fields(asked["fields"])}
        return asked

    def answer(asked: Json, said: Json) -> Json:
        if asked["do"] == "decode" and here(asked) and said.get("command") == command:
            return {**said, "fields": fields(said["fields"])}
        return said

    return Altered(table, question, answer)
