"""Choose the names, types and units of the columns of a table of messages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import pyarrow as pa

from cobotwire.codec.arrow_cells import cells_type, choices_in, numbers_in
from cobotwire.codec.table_columns import TableColumn, part_names, table_columns
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.fields import Variant
from cobotwire.protocol.table import Command, Direction, Table


@dataclass(frozen=True, slots=True)
class Layout:
    """Which columns a table of messages has. They depend on the message only, not on its rows.

    Attributes:
        table: the edition.
        command: the command of the messages.
        direction: whether they are requests or replies.
        shown: the variants whose rows the table can hold.
        raw: whether the numbers are raw values.
        wide: whether each number of a field has a column of its own.
    """

    table: Table
    command: Command
    direction: Direction
    shown: Sequence[Variant]
    raw: bool
    wide: bool

    def columns(self) -> Iterator[tuple[TableColumn, Any]]:
        """Yield each column after the leading ones, and its Arrow field with its unit.

        A column is nullable if a variant lacks it.

        Raises:
            UsageError: the variants have a field in common, but no type for it.
        """
        variants = self.command.variants(self.direction)
        for column in table_columns(variants, self.direction, self.wide):
            if any(column.find(variant) for variant in self.shown):
                yield column, self._field(column)

    def _field(self, column: TableColumn) -> Any:
        places = []
        for variant in self.shown:
            if found := column.find(variant):
                places.append((variant.fields[found[0]], found[1]))
            elif column.part and any(
                field.name == column.field and not part_names(field) for field in variant.fields
            ):
                raise self._no_common_type(column)
        type = common_type({cells_type(field, self.raw, part) for field, part in places})
        if type is None:
            raise self._no_common_type(column)
        units = dict.fromkeys([n.unit for place in places for n in numbers_in(*place)])
        metadata = {"unit": ", ".join(units)} if any(units) else {}
        if not self.raw and (choices := choices_in(*places[0])):
            metadata["values"] = ", ".join(f"{name}={raw}" for name, raw in choices.items())
        nullable = len(places) < len(self.shown)
        return pa.field(column.name, type, nullable, metadata or None)

    def _no_common_type(self, column: TableColumn) -> UsageError:
        message = (
            f"variants of the {self.command.name} {self.direction} differ in the type of "
            f"{column.field}: take the rows of one of them with rows({self.command.name!r}, "
            f"{self.direction!r}, variant=...)"
        )
        return UsageError("variants", self.command.name, message=message)


def common_type(types: set[Any]) -> Any:
    """Return a type that can hold the values of each of ``types``, or None.

    Fixed-size lists of several sizes become lists. Enums with different names become texts.
    Numbers of several types get the larger type.
    """
    if len(types) == 1:
        return next(iter(types))
    if all(pa.types.is_primitive(type) for type in types):
        return pa.float64() if pa.float64() in types else pa.int64()
    if all(pa.types.is_list(type) or pa.types.is_fixed_size_list(type) for type in types):
        element = common_type({type.value_type for type in types})
        return element and pa.list_(element)
    if all(pa.types.is_dictionary(type) or type == pa.utf8() for type in types):
        return pa.utf8()
    return None
