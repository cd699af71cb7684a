"""Name the columns of a table of messages: one for each field, or one for each of its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.protocol.fields import Field, Variant
from cobotwire.protocol.frame_format import Direction

# The columns before the fields. A table has some of them, depending on its source. Fields never get
# one of these names, so that the names of their columns are the same for every source.
LEADING = ("offset", "address", "time", "direction", "interface", "robot", "source")


class TableColumn(NamedTuple):
    """A column of a table of messages.

    Attributes:
        name: its name in the table.
        field: the name of the field.
        part: the name of one of the field's numbers or texts; empty: the column is the whole field.
    """

    name: str
    field: str
    part: str = ""

    def find(self, variant: Variant) -> tuple[int, int | None] | None:
        """Return the index of the field in a variant, and the index of its part.

        The second index is None for a whole field. Return None if the variant lacks the column.
        """
        for index, field in enumerate(variant.fields):
            if field.name == self.field:
                if not self.part:
                    return index, None
                parts = part_names(field)
                return (index, parts.index(self.part)) if self.part in parts else None
        return None


def table_columns(
    variants: Sequence[Variant], direction: Direction, wide: bool
) -> list[TableColumn]:
    """Return the columns that the variants of a message have together, in the order of the wire.

    With ``wide`` each number of a field has a column of its own, which has the name of the number,
    such as ``j1``. If the message has several columns of that name, or the number has no name, the
    name of the field precedes it: ``encoders_j1``, ``data_1``.
    """
    fields: dict[str, dict[str, None]] = {}
    for variant in sorted(variants, key=lambda variant: len(variant.fields), reverse=True):
        for field in variant.fields:
            named = dict.fromkeys(part_names(field) if wide else ())
            fields.setdefault(field.name, {}).update(named)
    whole = [column_name(name, direction) for name, parts in fields.items() if not parts]
    found: list[TableColumn] = []
    taken = {*LEADING, *whole}
    for name, parts in fields.items():
        if not parts:
            found.append(TableColumn(column_name(name, direction), name))
            continue
        others = {part for other, its in fields.items() if other != name for part in its}
        unique = {*parts}.isdisjoint(taken | others)
        for part in parts:
            label = part if unique and part.isidentifier() else f"{name}_{part}"
            found.append(TableColumn(_free(label, found, whole), name, part))
    return found


def column_name(field: str, direction: Direction) -> str:
    """Return the name of a field's column: ``request_offset`` for a request's field ``offset``."""
    return f"{direction}_{field}" if field in LEADING else field


def part_names(field: Field) -> tuple[str, ...]:
    """Return the names of a field's numbers or texts, which become columns of a wide table.

    Numbers without a name, or with different names in different cases, are counted from 1. In a
    list of groups, the number of the group comes first: ``1_x``. The result is empty for a field
    that is one value: a number, bytes, a text, or a list of a size that varies.
    """
    if field.sizes is not None or not field.dimensions or field.kind == "bytes":
        return ()
    count, *each = field.dimensions
    if field.kind == "text":
        return _counted(count) if each else ()
    size = each[0] if each else count
    names = {tuple([number.name for number in case.numbers[:size]]) for case in field.cases}
    first = names.pop() if len(names) == 1 else ()
    if len({*first}) < size or not all(first):
        first = _counted(size)
    return tuple(
        [f"{group}_{name}" for group in _counted(count) for name in first] if each else first
    )


def _counted(count: int) -> tuple[str, ...]:
    return tuple([str(number) for number in range(1, count + 1)])


def _free(label: str, found: Sequence[TableColumn], whole: Sequence[str]) -> str:
    taken = {*LEADING, *whole, *[column.name for column in found]}
    while label in taken:
        label += "_"
    return label
