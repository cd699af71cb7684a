"""List the formats of exports. Each is a module with a function ``open_sink``."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, BinaryIO, NamedTuple, Protocol, cast

from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.extras import Extra, needed
from cobotwire.capture.export.plan import ExportPlan, FormatName


class Sink(Protocol):
    """Writes tables into one open file."""

    def write(self, batches: list[Batch]) -> None:
        """Append rows; the rows of one call become one block, if the format has blocks.

        If the format has a file for each message, all batches have the same schema.
        """
        ...

    def close(self) -> None:
        """Write what the format needs at its end; the file stays open."""
        ...


OpenSink = Callable[[BinaryIO, Any, ExportPlan], Sink]


class Format(NamedTuple):
    """A format: its file extensions, its package, and whether each message has a file of its own.

    If the export chooses the name of a file, the name has the first extension.
    """

    name: FormatName
    suffixes: tuple[str, ...]
    per_message: bool
    package: str
    extra: Extra

    def open_sink(self, file: BinaryIO, schema: Any, plan: ExportPlan) -> Sink:
        """Return a sink for tables of a schema (of any, if messages share a file)."""
        module = import_module(f"{__name__}.{self.name}_file")
        return cast(OpenSink, module.open_sink)(file, schema, plan)

    def check_installed(self) -> None:
        """Check that the package is installed.

        Raises:
            UsageError: it is not; the text names the extra.
        """
        needed("pyarrow", "arrow", "export")
        needed(self.package, self.extra, f"export to {self.name}")


FORMATS: dict[FormatName, Format] = {
    format.name: format
    for format in (
        Format("parquet", (".parquet",), True, "pyarrow.parquet", "arrow"),
        Format("csv", (".csv",), True, "pyarrow.csv", "arrow"),
        Format("arrow", (".arrow", ".feather"), True, "pyarrow", "arrow"),
        Format("mcap", (".mcap",), False, "mcap", "mcap"),
    )
}


def format_of(output: str) -> FormatName | None:
    """Return the format of a file extension; None if no format has it."""
    for format in FORMATS.values():
        if output.endswith(format.suffixes):
            return format.name
    return None
