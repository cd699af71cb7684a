"""What callers of the generated Python write: signatures, and what they get."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.forms import renames
from cobotwire_codegen.diff.types import Known
from cobotwire_codegen.model import Command
from cobotwire_codegen.render.parameters import (
    Parameter,
    argument_type,
    parameters,
    result_type,
    results,
)


def signature_changes(where: str, old: Command, new: Command, known: Known) -> Iterator[Finding]:
    """Arguments of the method, as far as the request does not tell already."""
    names = renames(old.requests, new.requests)
    before = {names.get(p.name, p.name): p for p in parameters(old)}
    after = {p.name: p for p in parameters(new)}
    stayed = [name for name in after if name in before]
    for name in stayed:
        yield from _argument(f"{where}/request/{name}", before[name], after[name], known)
    former = [name for name in before if name in after]
    if former != stayed:
        yield finding("argument-order-changed", where, words.names(former), words.names(stayed))


def _argument(where: str, old: Parameter, new: Parameter, known: Known) -> Iterator[Finding]:
    if old.optional != new.optional:
        yield finding(f"argument-now-{'optional' if new.optional else 'required'}", where)
    types = [_renamed(argument_type(old), known), argument_type(new)]
    before, after = ({*type.split(" | ")} - {"None"} for type in types)
    if before != after:
        # A whole number may stand wherever Python asks for a float.
        taken = after | ({"int"} if "float" in after else set())
        widened = before <= taken
        yield finding(f"argument-type-{'widened' if widened else 'changed'}", where, *types)


def result_changes(where: str, old: Command, new: Command, known: Known) -> Iterator[Finding]:
    """What the method returns, as far as the reply does not tell already."""
    names = renames(old.replies, new.replies)
    before = {names.get(p.name, p.name): _renamed(result_type(p), known) for p in results(old)}
    after = {p.name: result_type(p) for p in results(new)}
    # Results that came or went with their fields are told there.
    old_names = {names.get(f.name, f.name) for form in old.replies for f in form}
    told = old_names ^ {f.name for form in new.replies for f in form}
    shown = [_returned(side, told) for side in (before, after)]
    if old.replies and new.replies and shown[0] != shown[1]:
        yield finding("result-type-changed", f"{where}/reply", *shown)


def _returned(found: dict[str, str], told: set[str]) -> str:
    parts = {name: type for name, type in found.items() if name not in told}
    return words.names(f"{name}: {parts[name]}" for name in sorted(parts)) or "None"


def _renamed(annotation: str, known: Known) -> str:
    """An annotation with the classes' new names, which are told by themselves."""
    return re.sub(r"\w+", lambda match: known.classes.get(match[0], match[0]), annotation)
