"""Write rows to a Parquet file."""

from __future__ import annotations

from typing import Any, BinaryIO

import pyarrow.parquet as pq

from cobotwire.capture.export.batch import Batch, joined
from cobotwire.capture.export.plan import ExportPlan

# Only names get dictionaries: for measured values, pyarrow would build them and discard them.
NAMES = ["robot", "source"]


class ParquetSink:
    """Writes one row group for each call."""

    def __init__(self, writer: Any) -> None:
        self._writer = writer

    def write(self, batches: list[Batch]) -> None:
        """Append a row group."""
        table = joined(batches)
        self._writer.write_table(table, row_group_size=table.num_rows)

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
