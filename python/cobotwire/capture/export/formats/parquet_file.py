"""Write rows to a Parquet file."""

from __future__ import annotations

from typing import Any, BinaryIO

import pyarrow.parquet as pq

from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.plan import ExportPlan

# Dictionaries of measured values are tried and given up again: only names get them.
NAMES = ["robot", "source"]


class ParquetSink:
    """Writes one row group for each call."""

    def __init__(self, writer: Any) -> None:
        self._writer = writer

    def write(self, batch: Batch) -> None:
        """Append a row group."""
        self._writer.write_table(batch.table, row_group_size=max(batch.table.num_rows, 1))

    def close(self) -> None:
        """Write the footer."""
        self._writer.close()


def open_sink(file: BinaryIO, schema: Any, plan: ExportPlan) -> ParquetSink:
    """Return a sink for a file."""
    return ParquetSink(pq.ParquetWriter(file, schema, **settings(plan, schema)))


def settings(plan: ExportPlan, schema: Any) -> dict[str, Any]:
    """Return the settings of pyarrow's writer."""
    names = [name for name in NAMES if name in schema.names]
    return {"compression": plan.compression, "use_dictionary": names}
