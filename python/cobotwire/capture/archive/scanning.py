"""Read one message of an archive as Arrow tables or as a Dask DataFrame."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import pyarrow as pa

from cobotwire.capture.archive.engine import Engine, ThreadEngine
from cobotwire.capture.archive.pieces import Piece
from cobotwire.capture.export.extras import needed
from cobotwire.capture.export.plan import ExportPlan, Message
from cobotwire.capture.export.report import Report
from cobotwire.capture.export.sources import Source

Result = TypeVar("Result")


class PieceScan(NamedTuple):
    """A task: read the rows of one message from one piece."""

    plan: ExportPlan
    message: Message
    piece: Piece

    def table(self) -> Any:
        """Return the rows as a ``pyarrow.Table``."""
        source = Source(self.plan, Report(), lambda size: None)
        found = [
            _plain(batch.table)
            for batch in self.piece.batches(self.plan, source)
            if batch.message == self.message
        ]
        empty = _plain(source.empty_schema(self.message).empty_table())
        return pa.concat_tables([empty, *found])

    def frame(self) -> Any:
        """Return the rows as a pandas DataFrame with Arrow types."""
        return _frame(self.table())

    def report(self) -> Report:
        """Count what the piece holds, whatever its message."""
        report = Report()
        for _ in self.piece.batches(self.plan, Source(self.plan, report, lambda size: None)):
            pass
        return report


@dataclass(frozen=True)
class Scan:
    """The rows of one message of an archive; nothing is decoded until they are used.

    Each piece of the archive is one table or partition, in the order of the inputs. The rows of a
    piece are in the order of its stream.

    Attributes:
        message: the message.
        plan: what is read, and how.
        pieces: the pieces of the archive.
    """

    message: Message
    plan: ExportPlan
    pieces: tuple[Piece, ...]

    @property
    def schema(self) -> Any:
        """The ``pyarrow.Schema`` of the tables."""
        source = Source(self.plan, Report(), lambda size: None)
        return _plain(source.empty_schema(self.message).empty_table()).schema

    def tables(self, engine: Engine | None = None) -> Iterator[Any]:
        """Yield the ``pyarrow.Table`` of each piece, by default made by threads.

        Raises:
            UsageError, LinkError: an input cannot be opened or read.
        """
        return self._run(PieceScan.table, engine)

    def to_arrow(self, engine: Engine | None = None) -> Any:
        """Return all rows as one ``pyarrow.Table``, which must fit into memory."""
        return pa.concat_tables([self.schema.empty_table(), *self.tables(engine)])

    def report(self, engine: Engine | None = None) -> Report:
        """Count rows, noise and rejected frames of all messages: it reads the whole archive."""
        return Report.merge(self._run(PieceScan.report, engine))

    def delayed(self) -> list[Any]:
        """Return a ``dask.delayed`` Arrow table for each piece.

        Raises:
            UsageError: Dask is not installed.
        """
        dask = needed("dask", "dask", "delayed tables")
        table = dask.delayed(PieceScan.table, pure=True)
        return [table(task) for task in self._tasks()]

    def dataframe(self) -> Any:
        """Return a Dask DataFrame with a partition for each piece. Its columns have Arrow types.

        Raises:
            UsageError: Dask is not installed.
        """
        dataframe = needed("dask.dataframe", "dask", "a Dask DataFrame")
        meta = _frame(self.schema.empty_table())
        return dataframe.from_map(PieceScan.frame, self._tasks(), meta=meta)

    def _tasks(self) -> list[PieceScan]:
        return [PieceScan(self.plan, self.message, piece) for piece in self.pieces]

    def _run(
        self, function: Callable[[PieceScan], Result], engine: Engine | None
    ) -> Iterator[Result]:
        """Yield the results in the order of the pieces; those that come early wait."""
        early: dict[int, Result] = {}
        due = 0
        for number, result in (engine or ThreadEngine()).run(function, self._tasks()):
            early[number] = result
            while due in early:
                yield early.pop(due)
                due += 1


def _plain(table: Any) -> Any:
    """Return a table with plain texts: most libraries cannot group by Arrow's dictionaries."""
    schema = pa.schema(
        [
            field.with_type(field.type.value_type) if pa.types.is_dictionary(field.type) else field
            for field in table.schema
        ],
        table.schema.metadata,
    )
    return table.cast(schema)


def _frame(table: Any) -> Any:
    """Return a pandas DataFrame with the types of a table."""
    pandas = needed("pandas", "dask", "a Dask DataFrame")
    return table.to_pandas(types_mapper=pandas.ArrowDtype)
