"""Compares the fields of messages."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.diff import prose
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import match, order
from cobotwire_codegen.diff.types import Known, members, type_changes
from cobotwire_codegen.model import Field, Member, Type
from cobotwire_codegen.render.arguments import default_in_words


def field_changes(where: str, part: str, old: Field, new: Field, known: Known) -> Iterator[Finding]:
    """Compare one field; ``part`` is argument or result."""
    if old.name != new.name:
        yield finding(f"{part}-renamed", where, old.name, new.name)
    if old.const != new.const:
        numbers = ["free" if side.const is None else side.const for side in (old, new)]
        yield finding("constant-changed", where, *numbers)
    if old.counts != new.counts:
        listed = [f"the size of {side.counts}" if side.counts else "free" for side in (old, new)]
        yield finding("constant-changed", where, *listed)
    if old.echo != new.echo:
        loosened = (old.echo, new.echo) == ("required", "optional")
        rule = "echo-loosened" if loosened else "echo-changed"
        yield finding(rule, where, old.echo or "none", new.echo or "none")
    if old.optional != new.optional:
        yield finding(f"{part}-now-{'optional' if new.optional else 'required'}", where)
    if old.default != new.default:
        kind = "changed" if old.default and new.default else "added" if new.default else "removed"
        yield finding(f"default-{kind}", where, default_in_words(old), default_in_words(new))
    yield from _types(where, old, new, known)
    # A description that comes from the type is reported for the type.
    if (old.doc, new.doc) != (old.type.doc, new.type.doc):
        yield from prose.doc(where, old.doc, new.doc)


def _type(where: str, old: Type, new: Type, known: Known) -> Iterator[Finding]:
    yield from known.unreported(
        old, new, "types", where, lambda at: type_changes(at, old, new, known)
    )


def _types(where: str, old: Field, new: Field, known: Known) -> Iterator[Finding]:
    """Compare the type, or the types of the cases."""
    if bool(old.selector) != bool(new.selector):
        rule = "selector-added" if new.selector else "selector-removed"
        yield finding(rule, where, old.selector, new.selector)
    elif old.selector != new.selector:
        yield finding("selector-changed", where, old.selector, new.selector)
    if _by_cases(old) and _by_cases(new):
        # The field's own type is the type of the first case.
        yield from _cases(where, old, new, known)
    elif old.cases and new.cases:
        yield from _type(where, old.type, new.type, known)
        yield from _cases(where, old, new, known)
    elif old.cases or new.cases:
        for member, type in (*old.cases, *new.cases):
            pair = (type, new.type) if old.cases else (old.type, type)
            yield from _type(f"{where}/{member.name}", *pair, known)
    else:
        yield from _type(where, old.type, new.type, known)


def _by_cases(field: Field) -> bool:
    return bool(field.cases) and field.type == field.cases[0][1]


def _cases(where: str, old: Field, new: Field, known: Known) -> Iterator[Finding]:
    before, after = ([member for member, _ in side.cases] for side in (old, new))
    if not known.reports_members(before, after):
        yield from members(where, before, after)
    # Match by name, then the remaining cases by number, as the members of an enum.
    matched = match(old.cases, new.cases, _case_name).further(lambda case: case[0].value)
    for (_, old_type), (member, new_type) in matched.pairs:
        yield from _type(f"{where}/{member.name}", old_type, new_type, known)
    yield from order(where, matched, _case_name)


def _case_name(case: tuple[Member, Type]) -> str:
    return case[0].name
