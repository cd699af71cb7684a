"""Check that arguments and results tell variants apart, and that `arguments` lists every one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.model import Command, Edition, Variant, named_fields


def variants_distinguishable(edition: Edition) -> Iterator[Problem]:
    """Report pairs of variants with the same arguments or the same results."""
    for command in edition.commands:
        for one, other in combinations(command.requests, 2):
            if _some_call_fits_both(one, other):
                yield _same(command, "request", one, other)
        for one, other in combinations(command.replies, 2):
            # The result omits constants, so replies that differ only in constants look the same.
            if _names(one) == _names(other) and _constants(one) != _constants(other):
                yield _same(command, "reply", one, other)


def _same(command: Command, direction: str, one: Variant, other: Variant) -> Problem:
    names = ", ".join(sorted(_names(one) & _names(other)))
    part = "arguments" if direction == "request" else "results"
    shown = f"the same {part}: {names}" if names else f"no {part}"
    message = f"two variants of the {direction} of {command.name} have {shown}"
    advice = "rename a field in one of them, or make one a command of its own with shares_id"
    return Problem(command.place, "same-arguments", f"{message}; {advice}")


def _some_call_fits_both(one: Variant, other: Variant) -> bool:
    return _needed(one) | _needed(other) <= _names(one) & _names(other)


def _needed(variant: Variant) -> set[str]:
    return {field.name for field in variant if field.const is None and field.default is None}


def _names(variant: Variant) -> set[str]:
    return {field.name for field in variant if field.const is None}


def _constants(variant: Variant) -> list[tuple[str, int]]:
    return [(field.name, field.const) for field in variant if field.const is not None]


def order_complete(edition: Edition) -> Iterator[Problem]:
    """Report argument orders that are incomplete, or have unknown or misplaced arguments."""
    for command in edition.commands:
        if command.arguments:
            yield from _order(command)


def _order(command: Command) -> Iterator[Problem]:
    given = command.arguments
    known = (*named_fields(command.requests), *command.text_arguments)
    for name in dict.fromkeys(given):
        if name not in known:
            message = f"{command.name} has no argument {name}{nearest(name, known)}"
            yield Problem(command.place, "bad-arguments", message)
        elif given.count(name) > 1:
            message = f"the arguments of {command.name} name {name} twice"
            yield Problem(command.place, "bad-arguments", message)
    for name in known:
        if name not in given:
            message = f"the arguments of {command.name} lack {name}"
            yield Problem(command.place, "bad-arguments", message)
    if sorted(given) != sorted(known):
        return
    needed = [command.needs(name) for name in given]
    for index, name in enumerate(given):
        if needed[index] and not all(needed[:index]):
            message = f"{name} of {command.name} is required; list it before optional arguments"
            yield Problem(command.place, "bad-arguments", message)


RULES = (variants_distinguishable, order_complete)
