"""Compares the variants of messages and their fields."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.fields import field_changes
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import Matched, order
from cobotwire_codegen.diff.types import Known, shape
from cobotwire_codegen.model import Command, Field, Variant

Direction = Literal["request", "reply"]
# The word for a field, by the direction of its message.
PART: dict[Direction, str] = {"request": "argument", "reply": "result"}


def message_changes(
    where: str, old: Command, new: Command, direction: Direction, known: Known
) -> Iterator[Finding]:
    """Compare one message of a command in all its variants."""
    before, after = old.variants(direction), new.variants(direction)
    if not before or not after:
        yield from _presence(where, old, new, direction)
        return
    names = renames(before, after)
    matched = _match(before, after, names)
    # Match the remaining variants by length. Pair the rest from the shortest on, since a longer
    # variant often only adds optional fields.
    rest = Matched(sorted(matched.removed, key=len), sorted(matched.added, key=len))
    rest = rest.further(len).further(lambda variant: None)
    for removed_one, added_one in rest.pairs:
        yield from _reshaped(where, direction, removed_one, added_one, after, names)
    for variant in rest.removed:
        yield from _removed_variant(where, direction, variant, after, names)
    for variant in rest.added:
        yield from _new_variant(where, direction, variant, (before, after), names)
    yield from order(where, matched, lambda variant: words.variant(variant) or "no fields")
    part = PART[direction]
    for one, other in _field_pairs([*matched.pairs, *rest.pairs], names):
        yield from field_changes(f"{where}/{other.name}", part, one, other, known)


def _presence(where: str, old: Command, new: Command, direction: Direction) -> Iterator[Finding]:
    """Compare a message that only one side has."""
    before, after = old.variants(direction), new.variants(direction)
    # An acknowledgement that is added or removed has a finding of its own.
    if bool(before) == bool(after) or (direction == "reply" and old.ack != new.ack):
        return
    shown = [f"({words.variant(side[0])})" if side else "" for side in (before, after)]
    if direction == "reply":
        yield finding(f"reply-{'removed' if before else 'added'}", where, *shown)
    else:
        yield finding("request-variant-changed", where, *shown)


def renames(before: tuple[Variant, ...], after: tuple[Variant, ...]) -> dict[str, str]:
    """Return the fields that have a new name in the same position, with the same type."""
    old_names, new_names = (
        {field.name for variant in side for field in variant} for side in (before, after)
    )

    def renamed(one: Field, other: Field) -> bool:
        fresh = one.name not in new_names and other.name not in old_names
        return fresh and _same_type(one, other)

    def same(old: Variant, new: Variant) -> bool:
        pairs = zip(old, new)
        return all(one.name == other.name or renamed(one, other) for one, other in pairs)

    straight = list(zip(before, after))
    # Added or removed optional fields shift the positions of variants. Compare every pair of
    # variants, and accept a pair only if all its other fields are equal.
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
    before: tuple[Variant, ...], after: tuple[Variant, ...], names: dict[str, str]
) -> Matched[Variant]:
    """Match variants with the same fields, first those with the same constants."""

    def exact(variant: Variant) -> object:
        return [(names.get(field.name, field.name), field.const) for field in variant]

    return Matched(before, after).further(exact).further(lambda variant: _named(variant, names))


def _named(variant: Variant, names: dict[str, str]) -> list[str]:
    # Only old names are keys of ``names``, so the names of new variants stay unchanged.
    return [names.get(field.name, field.name) for field in variant]


def _reshaped(
    where: str,
    direction: Direction,
    removed_one: Variant,
    added_one: Variant,
    legal: tuple[Variant, ...],
    names: dict[str, str],
) -> Iterator[Finding]:
    """Compare a variant with the one that replaced it."""
    before, after = _named(removed_one, names), _named(added_one, names)
    removed = [field for field in removed_one if names.get(field.name, field.name) not in after]
    added = [field for field in added_one if field.name not in before]
    stayed = [n for n in before if n in after], [n for n in after if n in before]
    constant = any(field.const is not None for field in (*removed, *added))
    moved = stayed[0] != stayed[1] or constant
    if moved:
        yield finding(
            f"{direction}-variant-changed",
            where,
            words.variant(removed_one),
            words.variant(added_one),
        )
    lost = [field for field in removed if field.const is None]
    for field in lost:
        yield _removed(where, direction, field)
    rules = {f.name: _added(direction, f, legal) for f in added if f.const is None}
    for name, rule in rules.items():
        yield finding(rule, f"{where}/{name}", "", name)
    # The shorter variant is now rejected, even if another variant lacks the added fields.
    if not (moved or lost) and {*rules.values()} <= {"argument-added-optional"}:
        yield finding(
            f"{direction}-variant-removed", where, words.variant(removed_one) or "no fields"
        )


def _added(direction: Direction, field: Field, legal: tuple[Variant, ...]) -> str:
    """Return the rule for an added field: it is optional if a variant lacks it."""
    if direction == "reply":
        return "result-added"
    everywhere = all(field.name in {other.name for other in variant} for variant in legal)
    return f"argument-added-{'required' if everywhere else 'optional'}"


def _removed_variant(
    where: str,
    direction: Direction,
    variant: Variant,
    after: tuple[Variant, ...],
    names: dict[str, str],
) -> Iterator[Finding]:
    """Report a removed variant that nothing replaces.

    If it was the only request with an argument, callers can no longer give that argument. A removed
    reply only means that this variant is no longer accepted.
    """
    known = {field.name for other in after for field in other}
    lost = [field for field in variant if names.get(field.name, field.name) not in known]
    lost = [field for field in lost if field.const is None and direction == "request"]
    for field in lost:
        yield _removed(where, direction, field)
    if not lost:
        yield finding(f"{direction}-variant-removed", where, words.variant(variant) or "no fields")


def _new_variant(
    where: str,
    direction: Direction,
    variant: Variant,
    sides: tuple[tuple[Variant, ...], tuple[Variant, ...]],
    names: dict[str, str],
) -> Iterator[Finding]:
    """Report an added variant."""
    known = {name for other in sides[0] for name in _named(other, names)}
    everywhere = set.intersection(*({f.name for f in other} for other in sides[1]))
    fresh = [f for f in variant if f.const is None and f.name not in known | everywhere]
    if direction == "reply" or not fresh:
        yield finding(
            f"{direction}-variant-added", where, "", words.variant(variant) or "no fields"
        )
    else:
        for field in fresh:
            place = f"{where}/{field.name}"
            yield finding("argument-added-optional", place, "", field.name)


def _removed(where: str, direction: Direction, field: Field) -> Finding:
    return finding(f"{PART[direction]}-removed", f"{where}/{field.name}", field.name)


def _field_pairs(
    variants: list[tuple[Variant, Variant]], names: dict[str, str]
) -> dict[tuple[Field, Field], None]:
    """Return the fields with their former versions, each pair once."""
    return dict.fromkeys(
        (one, other)
        for before, after in variants
        for one in before
        for other in after
        if names.get(one.name, one.name) == other.name
    )
