"""Rules for variants: decoders can distinguish the messages of one id, direction and length."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from typing import Any, Literal

from cobotwire_codegen import lower
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Command, Edition, Field, Value, Variant
from cobotwire_codegen.model.shapes import Shaped

# Each size is a variant of its own in the table of the codecs.
MOST_SIZES = 512
_DIRECTIONS: tuple[Literal["request", "reply"], ...] = ("request", "reply")


def variants_apart(edition: Edition) -> Iterator[Problem]:
    """Report messages of one id, direction and length that a decoder cannot distinguish."""
    for direction in _DIRECTIONS:
        # Replies without an id are paired with their request by address and size.
        named = edition.frame.has_command(direction)
        seen: dict[tuple[int | str, int], list[tuple[Command, Variant]]] = {}
        for command in edition.commands:
            for variant in command.variants(direction):
                reported: set[str] = set()
                for length in _lengths(variant):
                    others = seen.setdefault((command.id if named else command.name, length), [])
                    for other, known in others:
                        apart = _apart(command, variant, other, known, direction)
                        if not apart and other.name not in reported:
                            reported.add(other.name)
                            message = (
                                f"the {direction} of {command.name} has the id {command.id:#04x} "
                                f"and {length} data bytes, like {other.name} at {other.place}"
                            )
                            yield Problem(command.place, "ambiguous-variant", message)
                    others.append((command, variant))


def sizes_bounded(edition: Edition) -> Iterator[Problem]:
    """Report messages with too many sizes, or with several variants and a size that varies."""
    for command in edition.commands:
        for direction in _DIRECTIONS:
            variants = command.variants(direction)
            counts = [_combinations(variant) for variant in variants]
            if sum(counts) > MOST_SIZES and max(counts) > 1:
                message = f"the {direction} of {command.name} has {sum(counts)} sizes"
                yield Problem(command.place, "bad-size", f"{message}; allowed: {MOST_SIZES}")
            elif len(variants) > 1 and max(counts) > 1:
                message = f"the {direction} of {command.name} has several variants, and a size"
                yield Problem(command.place, "bad-size", f"{message} that varies")


def _combinations(variant: Variant) -> int:
    sizes = [field.type.sizes for field in variant]
    return prod(most - least + 1 for least, most in sizes)


def _lengths(variant: Variant) -> list[int]:
    """Return every number of data bytes that a variant can have."""
    found = {0}
    for field in variant:
        least, most = field.type.sizes
        sizes = [count * field.type.element_size for count in range(least, most + 1)]
        found = {length + size for length in found for size in sizes}
    return sorted(found)


def _apart(
    command: Command, variant: Variant, other: Command, known: Variant, direction: str
) -> bool:
    """Return whether a decoder can distinguish two messages, or need not distinguish them."""
    if command is not other:
        if other.name == command.alias:
            return True
        # Replies with the same numbers and rules decode to the same values for both requests.
        if direction == "reply" and _rules(variant) == _rules(known):
            return True
    here, there = _places(variant), _places(known)
    return any(_excluded(field, there[place]) for place, field in here.items() if place in there)


def _rules(variant: Variant) -> object:
    return [
        (field.type.numbers, field.type.sizes, field.selector, field.const) for field in variant
    ]


def _places(variant: Variant) -> dict[int, Field]:
    """Return the fields of one number without a selector, by offset, before any varying size."""
    found: dict[int, Field] = {}
    at = 0
    for field in variant:
        if field.type.varies:
            break
        if not field.selector and not isinstance(field.type, Value | Shaped):
            found[at] = field
        at += field.type.size
    return found


def _excluded(one: Field, other: Field) -> bool:
    """Return whether one of two fields at the same place has a constant that the other excludes."""
    [a], [b] = one.type.numbers, other.type.numbers
    if any(a.get(key) != b.get(key) for key in ("width", "order", "signed_at", "encoding")):
        return False
    pairs = ((one.const, other, b), (other.const, one, a))
    return any(
        const is not None and not _allows(field, number, const) for const, field, number in pairs
    )


def _allows(field: Field, number: dict[str, Any], raw: int) -> bool:
    choices = lower.field_choices(field)
    return raw in choices if choices else number["minimum"] <= raw <= number["maximum"]


RULES = (variants_apart, sizes_bounded)
