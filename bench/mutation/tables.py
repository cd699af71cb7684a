"""Tables that are wrong in one place: what a codec, or a client, would have misread in the spec."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from cobotwire.table import Case, Command, Direction, Field, Layout, Number, Table

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


class Place(NamedTuple):
    """Where a fault sits: a field of one form of one message; ``field`` -1 is the whole layout."""

    command: str
    direction: Direction
    form: int
    field: int = -1


class WrongTable(NamedTuple):
    """A fault of some ``kind``, and a table that has it."""

    kind: str
    place: Place
    text: str
    table: Table

    @property
    def id(self) -> str:
        """No two of an edition share it."""
        command, direction, form, _ = self.place
        return f"{self.kind}: {command} {direction} {form + 1}: {self.text}"


def wrong_tables(table: Table, directions: tuple[Direction, ...] = DIRECTIONS) -> list[WrongTable]:
    """Every fault of every field and form of an edition."""
    return [
        fault
        for command in table.commands
        for direction in directions
        for form, layout in enumerate(command.layouts(direction))
        for place in (Place(command.name, direction, form),)
        for fault in (*_of_layout(table, place, layout), *_of_form(table, place))
    ]


def layout_at(table: Table, place: Place) -> Layout:
    """The form that a fault sits in."""
    return table.command(place.command).layouts(place.direction)[place.form]


def _of_layout(table: Table, place: Place, layout: Layout) -> Iterator[WrongTable]:
    for index, field in enumerate(layout.fields):
        at = place._replace(field=index)
        for kind, text, wrong in _of_field(field):
            yield WrongTable(kind, at, f"{field.name} {text}", _with_field(table, at, wrong))
    for first in range(len(layout.fields) - 1):
        a, b = layout.fields[first : first + 2]
        if a.selector < 0 and b.selector < 0 and not _chosen(layout, first, first + 1):
            fields = (*layout.fields[:first], b, a, *layout.fields[first + 2 :])
            text = f"{b.name} before {a.name}"
            yield WrongTable("order", place, text, _with_layout(table, place, Layout(fields)))


def _of_form(table: Table, place: Place) -> Iterator[WrongTable]:
    """The form under another id, and not at all."""
    command = table.command(place.command)
    if place.form == 0:
        taken = {other.id for other in table.commands}
        free = next(id for id in range(command.id + 1, command.id + 256) if id % 256 not in taken)
        wrong = with_command(table, command, replace(command, id=free % 256))
        yield WrongTable("id", place, f"id {free % 256:02X}", wrong)
    forms = command.layouts(place.direction)
    rest = (*forms[: place.form], *forms[place.form + 1 :])
    wrong = with_command(table, command, _with_forms(command, place.direction, rest))
    yield WrongTable("form", place, "without this form", wrong)


def _chosen(layout: Layout, *indices: int) -> bool:
    """Whether another field reads by one of these."""
    return any(field.selector in indices for field in layout.fields)


def _of_field(field: Field) -> Iterator[tuple[str, str, Field]]:
    for kind, text, change in NUMBERS:
        if field.choices and kind in UNREAD_BEHIND_LISTS:
            continue
        wrong = _each_number(field, change)
        if wrong != field:
            yield kind, text, wrong
    yield from _of_list(field)
    if len(field.cases) > 1 and field.cases[0].numbers != field.cases[1].numbers:
        first, second = field.cases[0], field.cases[1]
        cases = (
            replace(first, numbers=second.numbers),
            replace(second, numbers=first.numbers),
            *field.cases[2:],
        )
        yield "case", "read by another case", replace(field, cases=cases)


def _of_list(field: Field) -> Iterator[tuple[str, str, Field]]:
    if not field.choices:
        return
    number = field.cases[0].numbers[0]
    if len(field.choices) > 1:
        yield (
            "list",
            "without its last",
            replace(field, choices=field.choices[:-1], labels=field.labels[:-1]),
        )
    more = max(field.choices) + 1
    if more <= number.signed_at:
        labels = (*field.labels, "MORE") if field.labels else ()
        wider = Case((), tuple(replace(n, maximum=max(n.maximum, more)) for n in (number,)))
        cases = (wider,) if len(field.cases) == 1 and not field.many else field.cases
        yield (
            "list",
            "with one more",
            replace(field, choices=(*field.choices, more), labels=labels, cases=cases),
        )


def _each_number(field: Field, change: Callable[[Number], Number]) -> Field:
    cases = tuple(
        replace(case, numbers=tuple(change(number) for number in case.numbers))
        for case in field.cases
    )
    return replace(field, cases=cases)


def _sign(number: Number) -> Number:
    """Signed where it is not, unsigned where it is; no fault where no legal number shows it."""
    top = 256**number.width - 1
    if number.minimum >= 0 and number.maximum <= top // 2:
        return number
    signed_at = top if number.signed_at < top else top // 2
    return replace(number, signed_at=signed_at)


def _lifted(number: Number) -> Number:
    """As :func:`_sign`, and the range follows: all that the word can then hold."""
    top = 256**number.width - 1
    if number.signed_at < top:
        return replace(number, signed_at=top, minimum=0, maximum=top)
    return replace(number, signed_at=top // 2, minimum=-(top // 2) - 1, maximum=top // 2)


def _narrow(number: Number, low: int, high: int) -> Number:
    wrong = replace(number, minimum=number.minimum + low, maximum=number.maximum + high)
    return wrong if wrong.minimum <= wrong.maximum and _carried(wrong) else number


def _carried(number: Number) -> bool:
    top = 256**number.width
    lowest = number.signed_at + 1 - top if number.signed_at < top - 1 else 0
    return lowest <= number.minimum and number.maximum <= number.signed_at


def _width(number: Number, step: int) -> Number:
    """Another width, with the same kind of sign."""
    width = number.width + step
    if width < 1:
        return number
    top = 256**width - 1
    signed = number.signed_at < 256**number.width - 1
    at = top // 2 if signed else top
    low = max(number.minimum, at - top if signed else 0)
    return replace(number, width=width, signed_at=at, minimum=low, maximum=min(number.maximum, at))


def _other_order(number: Number) -> Number:
    if number.width == 1:
        return number
    return replace(number, order="little" if number.order == "big" else "big")


NUMBERS: tuple[tuple[str, str, Callable[[Number], Number]], ...] = (
    ("scale", "ten times as large", lambda n: replace(n, multiply=n.multiply * 10)),
    ("scale", "a tenth as large", lambda n: replace(n, divide=n.divide * 10)),
    ("sign", "with the other sign rule", _sign),
    ("sign", "with the other sign rule and its range", _lifted),
    ("endianness", "low byte first", _other_order),
    ("width", "a byte wider", lambda n: _width(n, 1)),
    ("width", "a byte narrower", lambda n: _width(n, -1)),
    ("bounds", "from one step lower", lambda n: _narrow(n, -1, 0)),
    ("bounds", "from one step higher", lambda n: _narrow(n, 1, 0)),
    ("bounds", "to one step lower", lambda n: _narrow(n, 0, -1)),
    ("bounds", "to one step higher", lambda n: _narrow(n, 0, 1)),
)


# A closed list says all that is allowed; bounds and sign rule of its numbers are not looked at.
UNREAD_BEHIND_LISTS = ("bounds", "sign")


def _with_field(table: Table, place: Place, field: Field) -> Table:
    layout = layout_at(table, place)
    fields = (*layout.fields[: place.field], field, *layout.fields[place.field + 1 :])
    return _with_layout(table, place, Layout(fields))


def _with_layout(table: Table, place: Place, layout: Layout) -> Table:
    command = table.command(place.command)
    forms = command.layouts(place.direction)
    forms = (*forms[: place.form], layout, *forms[place.form + 1 :])
    return with_command(table, command, _with_forms(command, place.direction, forms))


def _with_forms(command: Command, direction: Direction, forms: tuple[Layout, ...]) -> Command:
    if direction == "request":
        return replace(command, request=forms)
    return replace(command, reply=forms)


def with_command(table: Table, old: Command, new: Command) -> Table:
    """The table with one command in the place of another."""
    commands = (new if command is old else command for command in table.commands)
    return replace(table, commands=tuple(commands))
