"""Write rows to an Arrow IPC file (Feather 2)."""

from __future__ import annotations

from typing import Any, BinaryIO

import pyarrow as pa

from cobotwire.capture.export.batch import Batch, joined
from cobotwire.capture.export.plan import ExportPlan

# The format has no other codecs.
_CODECS = {"zstd": "zstd", "lz4": "lz4", "snappy": "lz4", "none": None}


class ArrowSink:
    """Writes record batches."""

    def __init__(self, writer: Any, schema: Any) -> None:
        self._writer, self._schema = writer, schema

    def write(self, batches: list[Batch]) -> None:
        """Append record batches."""
        self._writer.write_table(joined(batches).cast(self._schema))

    def close(self) -> None:
        """Write the footer."""
        self._writer.close()


def open_sink(file: BinaryIO, schema: Any, plan: ExportPlan) -> ArrowSink:
    """Return a sink for a file."""
    options = pa.ipc.IpcWriteOptions(compression=_CODECS[plan.compression])
    plain = without_dictionaries(schema)
    return ArrowSink(pa.ipc.new_file(file, plain, options=options), plain)


def without_dictionaries(schema: Any) -> Any:
    """Return a schema with plain values: all batches of an IPC file must share one dictionary."""
    fields = [
        field.with_type(field.type.value_type) if pa.types.is_dictionary(field.type) else field
        for field in schema
    ]
    return pa.schema(fields, metadata=schema.metadata)
