"""The forms of a message: which are legal, what each carries."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.fields import field_changes
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import Matched, order
from cobotwire_codegen.diff.types import Known, shape
from cobotwire_codegen.model import Command, Field, Form

Direction = Literal["request", "reply"]
# What a field is to callers, by the direction of its message.
PART: dict[Direction, str] = {"request": "argument", "reply": "result"}


def message_changes(
    where: str, old: Command, new: Command, direction: Direction, known: Known
) -> Iterator[Finding]:
    """One message of a command, in all its forms."""
    before, after = old.forms(direction), new.forms(direction)
    if not before or not after:
        yield from _presence(where, old, new, direction)
        return
    names = renames(before, after)
    matched = _match(before, after, names)
    # Of what is left over, a form of the same length is the nearest, then the shortest one: what
    # longer forms have besides may be left out.
    rest = Matched(sorted(matched.gone, key=len), sorted(matched.came, key=len))
    rest = rest.further(len).further(lambda form: None)
    for gone, came in rest.pairs:
        yield from _reshaped(where, direction, gone, came, after, names)
    for form in rest.gone:
        yield from _lonely(where, direction, form, after, names)
    for form in rest.came:
        yield from _new_form(where, direction, form, (before, after), names)
    yield from order(where, matched, lambda form: words.form(form) or "no fields")
    part = PART[direction]
    for one, other in _field_pairs([*matched.pairs, *rest.pairs], names):
        yield from field_changes(f"{where}/{other.name}", part, one, other, known)


def _presence(where: str, old: Command, new: Command, direction: Direction) -> Iterator[Finding]:
    """A message that only one side has."""
    before, after = old.forms(direction), new.forms(direction)
    # An acknowledgement that comes or goes is told as such.
    if bool(before) == bool(after) or (direction == "reply" and old.ack != new.ack):
        return
    shown = [f"({words.form(side[0])})" if side else "" for side in (before, after)]
    if direction == "reply":
        yield finding(f"reply-{'removed' if before else 'added'}", where, *shown)
    else:
        yield finding("request-layout-changed", where, *shown)


def renames(before: tuple[Form, ...], after: tuple[Form, ...]) -> dict[str, str]:
    """Fields that have a new name in the same position, with the same type."""
    old_names, new_names = (
        {field.name for form in side for field in form} for side in (before, after)
    )

    def renamed(one: Field, other: Field) -> bool:
        fresh = one.name not in new_names and other.name not in old_names
        return fresh and _same_type(one, other)

    def same(old: Form, new: Form) -> bool:
        pairs = zip(old, new)
        return all(one.name == other.name or renamed(one, other) for one, other in pairs)

    straight = list(zip(before, after))
    # Optional fields that came or went put forms in other places; there, all else must be equal.
    crossed = [(old, new) for old in before for new in after if same(old, new)]
    found: dict[str, str] = {}
    for old, new in (*straight, *crossed):
        for one, other in zip(old, new) if len(old) == len(new) else ():
            if other.name not in found.values() and renamed(one, other):
                found.setdefault(one.name, other.name)
    return found


def _same_type(one: Field, other: Field) -> bool:
    return one.type.name == other.type.name or shape(one.type) == shape(other.type)


def _match(
    before: tuple[Form, ...], after: tuple[Form, ...], names: dict[str, str]
) -> Matched[Form]:
    """Forms with the same fields; among these, first those with the same fixed numbers."""

    def exact(form: Form) -> object:
        return [(names.get(field.name, field.name), field.const) for field in form]

    return Matched(before, after).further(exact).further(lambda form: _named(form, names))


def _named(form: Form, names: dict[str, str]) -> list[str]:
    # A new name is no old one, so that new forms pass unchanged.
    return [names.get(field.name, field.name) for field in form]


def _reshaped(
    where: str,
    direction: Direction,
    gone: Form,
    came: Form,
    legal: tuple[Form, ...],
    names: dict[str, str],
) -> Iterator[Finding]:
    """A form in the place of another one."""
    before, after = _named(gone, names), _named(came, names)
    removed = [field for field in gone if names.get(field.name, field.name) not in after]
    added = [field for field in came if field.name not in before]
    stayed = [n for n in before if n in after], [n for n in after if n in before]
    constant = any(field.const is not None for field in (*removed, *added))
    moved = stayed[0] != stayed[1] or constant
    if moved:
        yield finding(f"{direction}-layout-changed", where, words.form(gone), words.form(came))
    lost = [field for field in removed if field.const is None]
    for field in lost:
        yield _removed(where, direction, field)
    rules = {f.name: _added(direction, f, legal) for f in added if f.const is None}
    for name, rule in rules.items():
        yield finding(rule, f"{where}/{name}", "", name)
    # The shorter form is refused, even where all that came may be left out of another one.
    if not (moved or lost) and {*rules.values()} <= {"argument-added-optional"}:
        yield finding(f"{direction}-form-removed", where, words.form(gone) or "no fields")


def _added(direction: Direction, field: Field, legal: tuple[Form, ...]) -> str:
    """The rule for a field that came: none is required where a form goes without it."""
    if direction == "reply":
        return "result-added"
    everywhere = all(field.name in {other.name for other in form} for form in legal)
    return f"argument-added-{'required' if everywhere else 'optional'}"


def _lonely(
    where: str, direction: Direction, form: Form, after: tuple[Form, ...], names: dict[str, str]
) -> Iterator[Finding]:
    """A form that went, with nothing in its place."""
    known = {field.name for other in after for field in other}
    lost = [field for field in form if names.get(field.name, field.name) not in known]
    lost = [field for field in lost if field.const is None]
    for field in lost:
        yield _removed(where, direction, field)
    if not lost:
        yield finding(f"{direction}-form-removed", where, words.form(form) or "no fields")


def _new_form(
    where: str,
    direction: Direction,
    form: Form,
    sides: tuple[tuple[Form, ...], tuple[Form, ...]],
    names: dict[str, str],
) -> Iterator[Finding]:
    """A form that came, beside those that stay."""
    known = {name for other in sides[0] for name in _named(other, names)}
    everywhere = set.intersection(*({f.name for f in other} for other in sides[1]))
    fresh = [f for f in form if f.const is None and f.name not in known | everywhere]
    if direction == "reply" or not fresh:
        yield finding(f"{direction}-form-added", where, "", words.form(form) or "no fields")
    else:
        for field in fresh:
            place = f"{where}/{field.name}"
            yield finding("argument-added-optional", place, "", field.name)


def _removed(where: str, direction: Direction, field: Field) -> Finding:
    return finding(f"{PART[direction]}-removed", f"{where}/{field.name}", field.name)


def _field_pairs(
    forms: list[tuple[Form, Form]], names: dict[str, str]
) -> dict[tuple[Field, Field], None]:
    """Fields with their former selves, each pair once."""
    return dict.fromkeys(
        (one, other)
        for before, after in forms
        for one in before
        for other in after
        if names.get(one.name, one.name) == other.name
    )
