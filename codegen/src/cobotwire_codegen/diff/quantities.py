"""Compares quantities: scale, unit, range, choices, radians."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.diff import prose, words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.language.meanings import in_words
from cobotwire_codegen.model import Quantity


def changes(where: str, old: Quantity, new: Quantity) -> Iterator[Finding]:
    """Compare everything except the wire type and the description."""
    if old.scale != new.scale:
        yield finding("scale-changed", where, old.scale, new.scale)
    if old.unit != new.unit:
        yield finding("unit-changed", where, old.unit, new.unit)
    yield from _range(where, old, new)
    yield from _choices(where, old, new)
    if old.not_finite != new.not_finite:
        allowed = ("finite numbers", "finite numbers, NaN and infinity")
        spoken = [allowed[side.not_finite] for side in (old, new)]
        yield finding("not-finite-changed", where, *spoken)
    if old.radians != new.radians:
        spoken = ["radians" if side.radians else old.unit or "numbers" for side in (old, new)]
        yield finding("radians-changed", where, *spoken)
    if old.meanings != new.meanings:
        yield finding("meanings-changed", where, *(in_words(side.meanings) for side in (old, new)))
    yield from prose.source(where, old.source, new.source)
    yield from prose.disputes(where, old.disputed, new.disputed)


def _range(where: str, old: Quantity, new: Quantity) -> Iterator[Finding]:
    # Without a range, the limits follow from wire type and scale, which are reported themselves.
    if old.range == new.range:
        return
    before, after = words.in_unit(old), words.in_unit(new)
    rule = "range-moved"
    if before == after:
        rule = "range-restated"
    elif before[0] <= after[0] and after[1] <= before[1]:
        rule = "range-narrowed"
    elif after[0] <= before[0] and before[1] <= after[1]:
        rule = "range-widened"
    yield finding(rule, where, words.span(before), words.span(after))


def _choices(where: str, old: Quantity, new: Quantity) -> Iterator[Finding]:
    if old.choices == new.choices:
        return
    before, after = set(old.choices), set(new.choices)
    rule = "choices-narrowed"
    if before == after:
        rule = "order-changed"
    elif not after or (before and before < after):
        rule = "choices-widened"
    yield finding(rule, where, words.choices(old), words.choices(new))
