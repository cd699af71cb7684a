"""Make models that are wrong in one place; the tests of each target must detect them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from cobotwire_codegen.model import Command, Edition, Field, Quantity, Value

Wrong = Callable[[Quantity], Quantity]

WRONG: dict[str, Wrong] = {
    "scale": lambda part: replace(part, scale=Fraction(1, 10), range=None),
    "sign": lambda part: replace(part, wire=replace(part.wire, signed_at=0xFFFF), range=None),
    "order": lambda part: replace(part, wire=replace(part.wire, order="little")),
}


def with_wrong_angles(edition: Edition, wrong: Wrong) -> Edition:
    """Return the edition with a fault in the fields of the reply to get_angles."""

    def field(old: Field) -> Field:
        assert isinstance(old.type, Value)
        items = tuple((name, wrong(part)) for name, part in old.type.items)
        return replace(old, type=replace(old.type, items=items))

    def command(old: Command) -> Command:
        if old.name != "get_angles":
            return old
        return replace(old, replies=tuple(tuple(map(field, variant)) for variant in old.replies))

    families = (
        replace(family, commands=tuple(map(command, family.commands)))
        for family in edition.families
    )
    return replace(edition, families=tuple(families))
