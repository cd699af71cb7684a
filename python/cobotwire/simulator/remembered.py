"""Remember what commands set, as ``read_by`` promises, for commands without a behaviour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cobotwire.protocol.fields import named_fields
from cobotwire.protocol.table import Command, Table

Arguments = frozenset[tuple[str, Any]]


class _PartAndRow(NamedTuple):
    """A query of one part by its number, the query of all parts, and their fields."""

    part: str
    argument: str
    part_field: str
    row: str
    row_field: str
    size: int


def _part_and_row(part: Command, row: Command) -> _PartAndRow | None:
    """Return how two queries of the same quantity correspond; None if not as part and row."""
    arguments, parts, rows = list(named_fields(part.request)), _reported(part), _reported(row)
    if len(arguments) != 1 or len(parts) != 1 or len(rows) != 1 or named_fields(row.request):
        return None
    one, many = (named_fields(c.reply)[n][0] for c, n in ((part, parts[0]), (row, rows[0])))
    numbers = many.cases[0].numbers
    if one.many or not many.many or numbers[0].unit != one.cases[0].numbers[0].unit:
        return None
    return _PartAndRow(part.name, arguments[0], parts[0], row.name, rows[0], len(numbers))


@dataclass
class Remembered:
    """The values that commands have set, by the query that reports them.

    If the query has arguments that the command also has, such as a joint, the values belong to
    these arguments only.
    """

    values: dict[tuple[str, Arguments], dict[str, Any]] = field(default_factory=dict)

    def store(self, table: Table, command: Command, fields: Mapping[str, Any]) -> None:
        """Remember what a request sets, if a query reads it back."""
        if command.read_by is None:
            return
        query = table.command(command.read_by.query)
        reported = _reported(query)
        pairs = command.read_by.fields or tuple((name, name) for name in reported)
        stated = {
            name: fields[source] if isinstance(source, str) else _physical(query, name, source)
            for name, source in pairs
            if not isinstance(source, str) or source in fields
        }
        asked = set(named_fields(query.request))
        key = (query.name, _hashable({n: v for n, v in fields.items() if n in asked}))
        self._keep(key, stated)
        for other in table.commands:
            if query.name in other.agrees_with and (both := _part_and_row(other, query)):
                self._keep_parts(both, stated)
            elif other.name in query.agrees_with and (both := _part_and_row(query, other)):
                self._keep_in_row(both, dict(key[1]), stated)

    def _keep(self, key: tuple[str, Arguments], stated: dict[str, Any]) -> None:
        # Newest last, so that it is found last.
        self.values[key] = {**self.values.pop(key, {}), **stated}

    def _keep_parts(self, both: _PartAndRow, stated: Mapping[str, Any]) -> None:
        """Let the query of one part report the parts of a row."""
        for at, value in enumerate(stated.get(both.row_field, ()), 1):
            key = (both.part, _hashable({both.argument: at}))
            self._keep(key, {both.part_field: value})

    def _keep_in_row(
        self, both: _PartAndRow, arguments: Mapping[str, Any], stated: Mapping[str, Any]
    ) -> None:
        """Let the query of the row report one part of it."""
        key = (both.row, _hashable({}))
        row = list(self.values.get(key, {}).get(both.row_field, [0] * both.size))
        at = arguments.get(both.argument, 0)
        if both.part_field in stated and 1 <= at <= len(row):
            row[at - 1] = stated[both.part_field]
            self._keep(key, {both.row_field: tuple(row)})

    def begin(self, query: str, field: str, value: Any) -> None:
        """Let a query report a value until something else is set."""
        self.values.setdefault((query, frozenset()), {})[field] = value

    def recall(self, query: Command, fields: Mapping[str, Any]) -> dict[str, Any]:
        """Return the remembered fields of a query's reply; of two values the newer one."""
        asked = _hashable(fields)
        found: dict[str, Any] = {}
        for (name, arguments), values in self.values.items():
            if name == query.name and arguments <= asked:
                found |= values
        return found


def _reported(query: Command) -> list[str]:
    """Return the fields of a query's reply that are neither constants nor repeat its request."""
    fields = named_fields(query.reply)
    names = [name for name, found in fields.items() if not any(each.echo for each in found)]
    return [*names, *(query.text.fields if query.text is not None else ())]


def _physical(query: Command, name: str, raw: int) -> Any:
    """Return the physical value of a raw one, as the reply of a query reports it."""
    fields = (each for variant in query.reply for each in variant.fields if each.name == name)
    number = next(iter(next(fields).cases[0].numbers))
    return number.physical(raw)


def _hashable(fields: Mapping[str, Any]) -> Arguments:
    rows = {name: tuple(v) if isinstance(v, list) else v for name, v in fields.items()}
    return frozenset(rows.items())
