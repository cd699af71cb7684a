"""Define a batch: rows of one message, on their way from an input to a file."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.capture.export.plan import Message


class Batch(NamedTuple):
    """Some rows of one message of one robot.

    Attributes:
        message: the message.
        edition: the name of the edition.
        robot: the name of the robot.
        table: a ``pyarrow.Table`` with the columns of :class:`MessageTables`.
    """

    message: Message
    edition: str
    robot: str
    table: Any


def joined(batches: list[Batch]) -> Any:
    """Return the rows of batches of one message as one table."""
    import pyarrow as pa

    return pa.concat_tables([batch.table for batch in batches])
