"""Make Arrow tables of the messages of a stream: one schema for each message."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import pyarrow as pa

from cobotwire.capture.captured_columns import StreamColumns
from cobotwire.capture.export.plan import Message
from cobotwire.codec.arrow import times
from cobotwire.codec.interface import Columns, Counters, Rows
from cobotwire.protocol.table import Table

# The columns before the fields: robot, input, offset in the stream, address, time. Editions without
# addresses in their frames lack the column `address`.
OWN = ("robot", "source", "offset", "address", "time")
TIME = pa.timestamp("ns", tz="UTC")


class Origin(NamedTuple):
    """Where rows come from.

    Attributes:
        robot: the name of the robot.
        source: the name of the input.
        stream: the stream of a recording; None for raw bytes, which have no times.
    """

    robot: str
    source: str
    stream: StreamColumns | None = None


class MessageTables:
    """Makes the tables of one edition's messages; all tables of a message have one schema."""

    def __init__(self, table: Table, wide: bool) -> None:
        self._table, self._wide = table, wide

    def schema(self, message: Message) -> Any:
        """Return the schema of a message; it does not depend on which variants occur."""
        nothing = memoryview(b"").cast("Q")
        counters = Counters(0, {}, {}, 0)
        columns = Columns(self._table, [], nothing, (nothing, nothing), counters)
        return self.table(columns, message, Origin("", "")).schema

    def table(self, columns: Columns, message: Message, origin: Origin) -> Any:
        """Return the rows of a message, in the order of the stream."""
        table = columns.to_arrow(
            message.command,
            message.direction,
            wide=self._wide,
            leading=lambda rows: _leading(rows, columns, origin),
        )
        # Rows of raw bytes have no time.
        place = table.schema.get_field_index("time")
        schema = table.schema.set(place, pa.field("time", TIME))
        return pa.Table.from_arrays(table.columns, schema=schema)


def occurring(columns: Columns) -> Counter[Message]:
    """Return the messages that occur in columns, with their numbers of rows."""
    found: Counter[Message] = Counter()
    for rows in columns:
        if len(rows):
            found[Message(rows.command.name, rows.direction)] += len(rows)
    return found


@lru_cache
def messages_of(table: Table) -> list[Message]:
    """Return the messages of an edition that occur in frames."""
    return [
        Message(command.name, direction)
        for command in table.commands
        for direction in ("request", "reply")
        if command.variants(direction)
    ]


def _leading(rows: Rows, columns: Columns, origin: Origin) -> Mapping[str, Any]:
    """Return the columns of ``OWN`` for some rows, without the address: ``to_arrow`` adds it."""
    size = len(rows)
    time = pa.nulls(size, TIME)
    if origin.stream is not None:
        time = next(
            (times(its) for each, its in zip(columns, origin.stream.times) if each is rows), time
        )
    return {
        "robot": _constant(origin.robot, size),
        "source": _constant(origin.source, size),
        "offset": rows.offset,
        "time": time,
    }


def _constant(text: str, size: int) -> Any:
    index = pa.repeat(pa.scalar(0, pa.int32()), size)
    return pa.DictionaryArray.from_arrays(index, pa.array([text], pa.utf8()))
