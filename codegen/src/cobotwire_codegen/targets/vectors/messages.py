"""Every form of every message: an ordinary one, its bounds, every choice; and what is refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from cobotwire_codegen.model import Command, Edition, Field, Form
from cobotwire_codegen.targets.vectors.law import Direction
from cobotwire_codegen.targets.vectors.slots import Slot, Wholes, slots, variants
from cobotwire_codegen.wire import enclose

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
# Ordinary numbers stand off the middle, each elsewhere, so that a wrong order of fields, bytes or
# cases shows.
SHARES = (0.61, 0.23, 0.83, 0.37, 0.71, 0.13, 0.53)


class Example(NamedTuple):
    """A message by its numbers, and the bytes that say it."""

    what: str
    command: Command
    direction: Direction
    form: Form
    wholes: Wholes
    data: bytes


class Beyond(NamedTuple):
    """A message with one number that the edition rules out.

    ``data`` holds the bytes that would say it, None where no word reads as that number.
    """

    example: Example
    field: Field
    element: int
    whole: int
    data: bytes | None


def examples(edition: Edition) -> Iterator[Example]:
    """Complete by construction: every form, every case, the bounds and choices of every number."""
    for command, direction, form in forms(edition):
        seen: set[bytes] = set()
        for what, wholes in _wholes(form):
            data = spell(edition, command, form, wholes)
            # Where a form has few numbers, its bounds and its choices are the same messages.
            if data not in seen:
                seen.add(data)
                yield Example(what, command, direction, form, wholes, data)


def forms(edition: Edition) -> Iterator[tuple[Command, Direction, Form]]:
    """Every form of every framed message."""
    for command in edition.commands:
        for direction in DIRECTIONS:
            for form in command.forms(direction):
                yield command, direction, form


def beyond(edition: Edition, example: Example) -> Iterator[Beyond]:
    """For each number of a message: the nearest ones that are ruled out."""
    for field in example.form:
        parts = slots(field, example.form, example.wholes)
        assert parts is not None, "an example has a case for every field"
        for element, slot in enumerate(parts):
            for whole in _outside(slot):
                numbers = list(example.wholes[field.name])
                numbers[element] = whole
                wholes = example.wholes | {field.name: tuple(numbers)}
                sayable = slot.sayable(whole) and not _picks(field, example.form)
                data = spell(edition, example.command, example.form, wholes) if sayable else None
                yield Beyond(example, field, element, whole, data)


def spell(edition: Edition, command: Command, form: Form, wholes: Wholes) -> bytes:
    """The frame that says these numbers, legal or not."""
    data = b""
    for field in form:
        for slot, whole in zip(slots(field, form, wholes) or (), wholes[field.name]):
            data += slot.word(whole)
    return enclose(edition.frame, command.id, data)


def _picks(field: Field, form: Form) -> bool:
    """Whether another field's case depends on this one: then its size is not known."""
    return any(other.by == field.name for other in form)


def _outside(slot: Slot) -> Iterator[int]:
    if not slot.choices:
        yield slot.lowest - 1
        yield slot.highest + 1
        return
    yield from sorted({whole + 1 for whole in slot.choices} - set(slot.choices))[:2]
    yield min(slot.choices) - 1


def _wholes(form: Form) -> Iterator[tuple[str, Wholes]]:
    for picked in variants(form):
        case = "".join(f", {name} {value}" for name, value in picked.items())
        for what, choose in _CHOOSERS:
            yield what + case, _message(form, picked, choose)
    for field in form:
        yield from _choices(form, field)


def _choices(form: Form, field: Field) -> Iterator[tuple[str, Wholes]]:
    """One message for each member of a closed list."""
    ordinary = _message(form, {}, _ordinary)
    for element, slot in enumerate(slots(field, form, ordinary) or ()):
        for choice in slot.choices:
            if field.by or len(ordinary[field.name]) > 1:
                numbers = list(ordinary[field.name])
                numbers[element] = choice
                yield f"{field.name} {choice}", ordinary | {field.name: tuple(numbers)}
            else:
                yield f"{field.name} {choice}", _message(form, {field.name: choice}, _ordinary)


Choose = Callable[[Slot, int], int]


def _message(form: Form, picked: dict[str, int], choose: Choose) -> Wholes:
    wholes: Wholes = {}
    count = 0
    # Selectors first: they decide what the others may be.
    for field in sorted(form, key=lambda field: bool(field.by)):
        parts = slots(field, form, wholes)
        assert parts is not None, "what is chosen for a selector has a case"
        numbers = []
        for slot in parts:
            numbers.append(picked.get(field.name, choose(slot, count)))
            count += 1
        wholes[field.name] = tuple(numbers)
    return {field.name: wholes[field.name] for field in form}


def _ordinary(slot: Slot, count: int) -> int:
    share = SHARES[count % len(SHARES)]
    if slot.choices:
        return slot.choices[int(share * len(slot.choices))]
    return round(slot.lowest + share * (slot.highest - slot.lowest))


def _nearest(wanted: int) -> Choose:
    def choose(slot: Slot, count: int) -> int:
        allowed = slot.choices or (min(max(wanted, slot.lowest), slot.highest),)
        return min(allowed, key=lambda whole: abs(whole - wanted))

    return choose


_CHOOSERS: tuple[tuple[str, Choose], ...] = (
    ("ordinary", _ordinary),
    ("lowest", lambda slot, count: min(slot.choices) if slot.choices else slot.lowest),
    ("highest", lambda slot, count: max(slot.choices) if slot.choices else slot.highest),
    ("zero", _nearest(0)),
    ("minus one", _nearest(-1)),
)
