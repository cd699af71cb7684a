"""Tables that are wrong in one place, as if a codec or a client had misread the spec."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from cobotwire.protocol.table import Case, Command, Direction, Field, Number, Table, Variant

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


class Place(NamedTuple):
    """The variant that has a fault, and the index of its wrong field; -1 for the whole variant."""

    command: str
    direction: Direction
    variant: int
    field: int = -1


class WrongTable(NamedTuple):
    """A fault of some ``kind``, and a table that has it."""

    kind: str
    place: Place
    text: str
    table: Table

    @property
    def name(self) -> str:
        """The place and the fault."""
        command, direction, variant, _ = self.place
        return f"{command} {direction} {variant + 1}: {self.text}"


def wrong_tables(table: Table, directions: tuple[Direction, ...] = DIRECTIONS) -> list[WrongTable]:
    """Return every fault of every field and variant of an edition."""
    return [
        fault
        for command in table.commands
        for direction in directions
        for index, variant in enumerate(command.variants(direction))
        for place in (Place(command.name, direction, index),)
        for fault in (*_of_variant(table, place, variant), *_of_message(table, place))
    ]


def variant_at(table: Table, place: Place) -> Variant:
    """Return the variant that has a fault."""
    return table.command(place.command).variants(place.direction)[place.variant]


def _of_variant(table: Table, place: Place, variant: Variant) -> Iterator[WrongTable]:
    for index, field in enumerate(variant.fields):
        at = place._replace(field=index)
        for kind, text, wrong in _of_field(field):
            yield WrongTable(kind, at, f"{field.name} {text}", _with_field(table, at, wrong))
    for first in range(len(variant.fields) - 1):
        a, b = variant.fields[first : first + 2]
        selectors = {field.selector for field in variant.fields}
        if max(a.selector, b.selector) < 0 and not {first, first + 1} & selectors:
            fields = (*variant.fields[:first], b, a, *variant.fields[first + 2 :])
            text = f"{b.name} before {a.name}"
            yield WrongTable("order", place, text, _with_variant(table, place, Variant(fields)))


def _of_message(table: Table, place: Place) -> Iterator[WrongTable]:
    """Yield the table with the variant under another id, and without it."""
    command = table.command(place.command)
    if place.variant == 0:
        taken = {other.id for other in table.commands}
        free = next(id for id in range(command.id + 1, command.id + 256) if id % 256 not in taken)
        wrong = with_command(table, command, command._replace(id=free % 256))
        yield WrongTable("id", place, f"id {free % 256:02X}", wrong)
    variants = command.variants(place.direction)
    rest = (*variants[: place.variant], *variants[place.variant + 1 :])
    wrong = with_command(table, command, _with_variants(command, place.direction, rest))
    yield WrongTable("variant", place, "without this variant", wrong)


def _of_field(field: Field) -> Iterator[tuple[str, str, Field]]:
    for kind, text, change in NUMBERS:
        if field.kind in ("bytes", "text") or (field.choices and kind in NOT_USED_WITH_LISTS):
            continue
        wrong = _each_number(field, change)
        if wrong != field:
            yield kind, text, wrong
    yield from _of_list(field)
    if len(field.cases) > 1 and field.cases[0].numbers != field.cases[1].numbers:
        first, second = field.cases[0], field.cases[1]
        cases = (
            first._replace(numbers=second.numbers),
            second._replace(numbers=first.numbers),
            *field.cases[2:],
        )
        yield "case", "first two cases swapped", field._replace(cases=cases)


def _of_list(field: Field) -> Iterator[tuple[str, str, Field]]:
    if not field.choices:
        return
    number = field.cases[0].numbers[0]
    if len(field.choices) > 1:
        yield (
            "list",
            "without its last choice",
            field._replace(choices=field.choices[:-1], labels=field.labels[:-1]),
        )
    more = max(field.choices) + 1
    if more <= number.signed_at:
        labels = (*field.labels, "MORE") if field.labels else ()
        wider = Case((), tuple(n._replace(maximum=max(n.maximum, more)) for n in (number,)))
        cases = (wider,) if len(field.cases) == 1 and not field.many else field.cases
        yield (
            "list",
            "with one more choice",
            field._replace(choices=(*field.choices, more), labels=labels, cases=cases),
        )


def _each_number(field: Field, change: Callable[[Number], Number]) -> Field:
    cases = tuple(
        case._replace(numbers=tuple(change(number) for number in case.numbers))
        for case in field.cases
    )
    return field._replace(cases=cases)


def _sign(number: Number) -> Number:
    """Return the number with the other sign rule, if that changes any legal value."""
    top = 256**number.width - 1
    if number.minimum >= 0 and number.maximum <= top // 2:
        return number
    signed_at = top if number.signed_at < top else top // 2
    return number._replace(signed_at=signed_at)


def _lifted(number: Number) -> Number:
    """Return the number with the other sign rule, and the whole range of that rule."""
    top = 256**number.width - 1
    if number.signed_at < top:
        return number._replace(signed_at=top, minimum=0, maximum=top)
    return number._replace(signed_at=top // 2, minimum=-(top // 2) - 1, maximum=top // 2)


def _narrow(number: Number, low: int, high: int) -> Number:
    wrong = number._replace(minimum=number.minimum + low, maximum=number.maximum + high)
    return wrong if wrong.minimum <= wrong.maximum and _carried(wrong) else number


def _carried(number: Number) -> bool:
    lowest, highest = number.raw_range
    return lowest <= number.minimum and number.maximum <= highest


def _width(number: Number, step: int) -> Number:
    """Return the number with another width and the same kind of sign rule."""
    width = number.width + step
    if width < 1:
        return number
    top = 256**width - 1
    signed = number.signed_at < 256**number.width - 1
    at = top // 2 if signed else top
    low = max(number.minimum, at - top if signed else 0)
    return number._replace(width=width, signed_at=at, minimum=low, maximum=min(number.maximum, at))


def _other_order(number: Number) -> Number:
    if number.width == 1:
        return number
    return number._replace(order="little" if number.order == "big" else "big")


NUMBERS: tuple[tuple[str, str, Callable[[Number], Number]], ...] = (
    ("scale", "ten times as large", lambda n: n._replace(multiply=n.multiply * 10)),
    ("scale", "a tenth as large", lambda n: n._replace(divide=n.divide * 10)),
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


# A closed list defines the legal values, so the bounds and the sign rule are not used.
NOT_USED_WITH_LISTS = ("bounds", "sign")


def _with_field(table: Table, place: Place, field: Field) -> Table:
    variant = variant_at(table, place)
    fields = (*variant.fields[: place.field], field, *variant.fields[place.field + 1 :])
    return _with_variant(table, place, Variant(fields))


def _with_variant(table: Table, place: Place, variant: Variant) -> Table:
    command = table.command(place.command)
    variants = command.variants(place.direction)
    variants = (*variants[: place.variant], variant, *variants[place.variant + 1 :])
    return with_command(table, command, _with_variants(command, place.direction, variants))


def _with_variants(
    command: Command, direction: Direction, variants: tuple[Variant, ...]
) -> Command:
    if direction == "request":
        return command._replace(request=variants)
    return command._replace(reply=variants)


def with_command(table: Table, old: Command, new: Command) -> Table:
    """Return the table with one command in place of another."""
    commands = (new if command is old else command for command in table.commands)
    return table._replace(commands=tuple(commands))
