"""Parts of the model in a few words, as findings show them."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from cobotwire_codegen.model import Command, Form, Member, Quantity, Text, Wire
from cobotwire_codegen.render.words import decimal, lines

LONGEST = 60

__all__ = [
    "choices",
    "form",
    "lines",
    "member",
    "names",
    "read_back",
    "short",
    "sign",
    "span",
    "template",
    "tries",
    "yes",
]


def short(text: str) -> str:
    """A sentence, cut where it gets long: the whole stands in the spec."""
    return text if len(text) <= LONGEST else text[: LONGEST - 3].rstrip() + "..."


def yes(value: bool) -> str:
    """A truth value."""
    return "yes" if value else "no"


def names(found: Iterable[str]) -> str:
    """A list of names."""
    return ", ".join(found)


def hexed(data: bytes) -> str:
    """Bytes as the spec writes them."""
    return data.hex(" ").upper()


def span(ends: tuple[Fraction, Fraction]) -> str:
    """A range."""
    return f"{decimal(ends[0])}..{decimal(ends[1])}"


def in_unit(quantity: Quantity) -> tuple[Fraction, Fraction]:
    """The range that holds, said or not, in the quantity's unit."""
    lowest, highest = quantity.bounds
    return lowest * quantity.scale, highest * quantity.scale


def choices(quantity: Quantity) -> str:
    """The closed list of numbers."""
    return names(map(str, quantity.choices)) or "any in range"


def sign(wire: Wire) -> str:
    """The rule of the sign."""
    return f"{wire.minimum}..{wire.maximum}"


def member(found: Member) -> str:
    """A member with its number."""
    return f"{found.name} = {found.value}"


def form(found: Form) -> str:
    """The fields of a message."""
    return names(
        field.name if field.const is None else f"{field.name} = {field.const}" for field in found
    )


def read_back(command: Command) -> str:
    """The query that reads a command's effect."""
    back = command.read_by
    if back is None:
        return "nothing"
    told = names(f"{name} = {said}" for name, said in back.fields)
    return f"{back.query} ({told})" if told else back.query


def tries(command: Command) -> str:
    """What a conformance run may send."""
    entries = (
        names(f"{name} {list(numbers)}" for name, numbers in entry) for entry in command.tries
    )
    return "; ".join(entries) or "any legal number"


def template(text: Text | None) -> str:
    """A text with its gaps, as the spec writes it."""
    if text is None:
        return ""
    gaps = (f"{prefix}{{{name}}}" for prefix, (name, _) in zip(text.prefixes, text.fields))
    return "".join(gaps) + text.suffix
