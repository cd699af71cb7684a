"""Find the offset of each number in a message, and the numbers that its selectors choose."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from cobotwire.protocol.table import Field, Number, Variant


@dataclass(frozen=True, slots=True)
class LocatedNumber:
    """One number of a variant; ``index`` is that of its field, ``element`` its own in the field.

    ``start`` is the offset of its first byte in the data bytes.
    """

    field: Field
    number: Number
    index: int
    element: int
    start: int

    @property
    def name(self) -> str:
        """The name in messages: ``speed``, ``coords.x``, ``joints[2].x``, ``data[0]``."""
        field = self.field
        if is_list(field):
            element, at = divmod(self.element, field.each or 1)
            part = f".{self.number.name}" if self.number.name else f"[{at}]"
            return f"{field.name}[{element}]{part if field.each else ''}"
        part = f".{self.number.name or self.element}" if field.many else ""
        return self.field.name + part

    def bytes_of(self, data: bytes) -> bytes:
        """Return the bytes of this number in the data bytes of a message."""
        return data[self.start : self.start + self.number.width]


def located_numbers(
    variant: Variant, picked: Mapping[int, int] | None = None
) -> Iterator[LocatedNumber]:
    """Yield every number of a variant, while its selectors hold the raw values in ``picked``.

    Without ``picked``, each field has its first case.
    """
    start = 0
    for index, field in enumerate(variant.fields):
        numbers = field.cases[0].numbers if picked is None else numbers_of(field, picked)
        for element, number in enumerate(numbers):
            yield LocatedNumber(field, number, index, element, start)
            start += number.step


def is_list(field: Field) -> bool:
    """Return whether a field is bytes, text, a list of groups, or a list of varying size."""
    varies = field.sizes is not None and not field.counts
    return field.many and (field.kind in ("bytes", "text") or bool(field.each) or varies)


def picks(variant: Variant) -> Iterator[dict[int, int]]:
    """Yield every combination of values of the selectors, by their index in the variant."""
    selectors = sorted({field.selector for field in variant.fields} - {-1})
    for chosen in product(*(_selecting(variant, index) for index in selectors)):
        yield dict(zip(selectors, chosen))


def _selecting(variant: Variant, index: int) -> list[int]:
    """Return the values of a selector that pick a case."""
    field = variant.fields[index]
    number = field.cases[0].numbers[0]
    known = {raw for f in variant.fields if f.selector == index for c in f.cases for raw in c.when}
    every = field.choices or range(number.minimum, number.maximum + 1)
    return [raw for raw in every if raw in known]


def numbers_of(field: Field, picked: Mapping[int, int]) -> tuple[Number, ...]:
    """Return the numbers of a field while the selectors hold the values in ``picked``."""
    case = field.case(picked.get(field.selector))
    assert case is not None, "a pick has a case"
    return case.numbers
