"""Write rows to a CSV file, with a header line."""

from __future__ import annotations

import json
from functools import partial
from typing import Any, BinaryIO

import pyarrow as pa
import pyarrow.csv

from cobotwire.capture.export.batch import Batch, joined
from cobotwire.capture.export.plan import ExportPlan


class CsvSink:
    """Writes lines. Bytes are hex; lists of a size that varies are JSON."""

    def __init__(self, writer: Any) -> None:
        self._writer = writer

    def write(self, batches: list[Batch]) -> None:
        """Append lines."""
        table = joined(batches)
        columns = [_as_cells(table.column(name)) for name in table.column_names]
        self._writer.write_table(pa.Table.from_arrays(columns, names=table.column_names))

    def close(self) -> None:
        """Write what is left."""
        self._writer.close()


def open_sink(file: BinaryIO, schema: Any, plan: ExportPlan) -> CsvSink:
    """Return a sink for a file."""
    fields = [(field.name, _as_cells(pa.chunked_array([], field.type)).type) for field in schema]
    return CsvSink(pyarrow.csv.CSVWriter(file, pa.schema(fields)))


def _as_cells(column: Any) -> Any:
    """Return a column with values that a cell can hold."""
    kind = column.type
    if pa.types.is_dictionary(kind):
        return column.cast(kind.value_type)
    if pa.types.is_timestamp(kind):
        # Text with all digits: a decimal point and nine digits, then Z.
        return column.cast(pa.utf8())
    if pa.types.is_binary(kind) or pa.types.is_large_binary(kind):
        return _texts(column, bytes.hex)
    if pa.types.is_nested(kind):
        return _texts(column, partial(json.dumps, default=bytes.hex))
    return column


def _texts(column: Any, format: Any) -> Any:
    values = (value.as_py() for value in column)
    return pa.array([None if value is None else format(value) for value in values], pa.utf8())
