"""Compares what callers of the generated Python see: arguments and results of methods."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.types import Known
from cobotwire_codegen.diff.variants import renames
from cobotwire_codegen.model import Command
from cobotwire_codegen.render.parameters import (
    Parameter,
    argument_type,
    parameters,
    reported_type,
    results,
)


def signature_changes(where: str, old: Command, new: Command, known: Known) -> Iterator[Finding]:
    """Compare the method's arguments, except for what the request's findings already report."""
    names = renames(old.requests, new.requests)
    before = {names.get(p.name, p.name): p for p in parameters(old)}
    after = {p.name: p for p in parameters(new)}
    stayed = [name for name in after if name in before]
    for name in stayed:
        yield from _argument(f"{where}/request/{name}", before[name], after[name], known)
    yield from _order(where, old, new, names)


def _order(where: str, old: Command, new: Command, names: dict[str, str]) -> Iterator[Finding]:
    sides = [[names.get(n, n) for n in old.argument_names], [*new.argument_names]]
    before, after = ([n for n in side if n in sides[0] and n in sides[1]] for side in sides)
    stated = [[names.get(n, n) for n in old.arguments], [*new.arguments]]
    # An argument that is added or removed has a finding of its own.
    same = set(sides[0]) == set(sides[1]) or not all(stated)
    if before != after:
        yield finding("argument-order-changed", where, words.names(before), words.names(after))
    elif stated[0] != stated[1] and same:
        yield finding("arguments-restated", where, "", words.names(new.argument_names))


def _argument(where: str, old: Parameter, new: Parameter, known: Known) -> Iterator[Finding]:
    if old.optional != new.optional:
        yield finding(f"argument-now-{'optional' if new.optional else 'required'}", where)
    types = [_renamed(argument_type(old), known), argument_type(new)]
    before, after = ({*type.split(" | ")} - {"None"} for type in types)
    if before != after:
        # An int is accepted wherever a float is expected.
        accepted = after | ({"int"} if "float" in after else set())
        widened = before <= accepted
        yield finding(f"argument-type-{'widened' if widened else 'changed'}", where, *types)


def result_changes(where: str, old: Command, new: Command, known: Known) -> Iterator[Finding]:
    """Compare the method's result, except for what the reply's findings already report."""
    names = renames(old.replies, new.replies)
    before = {names.get(p.name, p.name): _renamed(reported_type(p), known) for p in results(old)}
    after = {p.name: reported_type(p) for p in results(new)}
    # Results that were added or removed with their fields are reported there.
    old_names = {names.get(f.name, f.name) for variant in old.replies for f in variant}
    reported = old_names ^ {f.name for variant in new.replies for f in variant}
    shown = [_returned(side, reported) for side in (before, after)]
    if old.replies and new.replies and shown[0] != shown[1]:
        yield finding("result-type-changed", f"{where}/reply", *shown)


def _returned(found: dict[str, str], reported: set[str]) -> str:
    parts = {name: type for name, type in found.items() if name not in reported}
    return words.names(f"{name}: {parts[name]}" for name in sorted(parts)) or "None"


def _renamed(annotation: str, known: Known) -> str:
    """Return an annotation with the new names of classes, which are reported separately."""
    return re.sub(r"\w+", lambda match: known.classes.get(match[0], match[0]), annotation)
