"""Make Arrow tables of the messages of a stream: one schema for each message."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import pyarrow as pa

from cobotwire.capture.export.plan import Message
from cobotwire.codec.interface import Codec, Columns, Rows
from cobotwire.protocol.table import Table

# The columns before the fields: which robot, which input, where in the stream, when.
OWN = ("robot", "source", "offset", "time")
TIME = pa.timestamp("ns", tz="UTC")
_NAME = pa.dictionary(pa.int32(), pa.utf8())


class MessageTables:
    """Makes the tables of one edition's messages; all tables of a message have one schema."""

    def __init__(self, codec: Codec, wide: bool) -> None:
        self._codec, self._wide = codec, wide
        self._empty = codec.decode_columns(b"")
        self._schemas: dict[Message, Any] = {}

    @property
    def messages(self) -> list[Message]:
        """All messages of the edition that have variants."""
        return messages_of(self._codec.table)

    def schema(self, message: Message) -> Any:
        """Return the schema of a message, whichever of its variants occur."""
        if message not in self._schemas:
            count = len(self._codec.table.command(message.command).variants(message.direction))
            variants = [
                _fields(self._empty.rows(message.command, message.direction, index), self._wide)
                for index in range(count)
            ]
            self._schemas[message] = _with_own(_unified([table.schema for table in variants]))
        return self._schemas[message]

    def tables(
        self, columns: Columns, robot: str, source: str, times: Any = None
    ) -> list[tuple[Message, Any]]:
        """Return a table of each message that occurs, with its rows in the order of the stream.

        ``times`` returns the times of an array of offsets; None if the stream has no times.
        """
        found: dict[Message, list[Rows]] = {}
        for rows in columns:
            if len(rows):
                found.setdefault(Message(rows.command.name, rows.direction), []).append(rows)
        return [
            (message, self._table(message, variants, robot, source, times))
            for message, variants in found.items()
        ]

    def _table(
        self, message: Message, variants: list[Rows], robot: str, source: str, times: Any
    ) -> Any:
        schema = self.schema(message)
        parts = [_conform(_fields(rows, self._wide), schema) for rows in variants]
        fields = parts[0] if len(parts) == 1 else pa.concat_tables(parts).sort_by("offset")
        size = fields.num_rows
        time = pa.nulls(size, TIME) if times is None else times(fields.column("offset"))
        own = [_constant(robot, size), _constant(source, size), fields.column("offset"), time]
        return pa.Table.from_arrays([*own, *fields.columns[1:]], schema=schema)


@lru_cache
def messages_of(table: Table) -> list[Message]:
    """Return the messages of an edition that occur in frames."""
    return [
        Message(command.name, direction)
        for command in table.commands
        for direction in ("request", "reply")
        if command.variants(direction)
    ]


def _fields(rows: Rows, wide: bool) -> Any:
    """Return the offset and the fields of some rows; fields never have the name of our columns."""
    table = pa.table(rows)
    names = [f"field_{name}" if name in OWN else name for name in table.column_names[1:]]
    return table.rename_columns(["offset", *names])


def _unified(schemas: list[Any]) -> Any:
    """Return a schema with the columns of all variants; what some variants lack may be null."""
    unified = pa.unify_schemas(schemas)
    everywhere = set.intersection(*(set(schema.names) for schema in schemas))
    fields = [field.with_nullable(field.name not in everywhere) for field in unified]
    return pa.schema(fields)


def _with_own(fields: Any) -> Any:
    own = [
        pa.field("robot", _NAME, nullable=False),
        pa.field("source", _NAME, nullable=False),
        fields.field("offset"),
        pa.field("time", TIME),
    ]
    return pa.schema([*own, *list(fields)[1:]])


def _conform(table: Any, schema: Any) -> Any:
    """Return the offset and the fields with the types of a schema; null where there is no field."""
    fields = [schema.field("offset"), *list(schema)[len(OWN) :]]
    names = table.column_names
    columns = [
        table.column(field.name).cast(field.type)
        if field.name in names
        else pa.nulls(table.num_rows, field.type)
        for field in fields
    ]
    return pa.Table.from_arrays(columns, schema=pa.schema(fields))


def _constant(text: str, size: int) -> Any:
    indices = pa.array(memoryview(bytes(4 * size)).cast("i"), pa.int32())
    return pa.DictionaryArray.from_arrays(indices, pa.array([text], pa.utf8()))
