"""Write entries to files: a recording, or the tables that data tools read."""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Literal, NamedTuple, cast, get_args

from cobotwire.capture.export import ExportPlan, Inputs, write
from cobotwire.capture.export.plan import FormatName
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.writer import CaptureWriter
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import UsageError
from cobotwire.studio.describing import Describer
from cobotwire.studio.entries import Entry

FileFormat = Literal["pcapng", "parquet", "csv"]


class Selection(NamedTuple):
    """Which entries to write.

    Attributes:
        format: the format of the file.
        begin: the first time, in seconds since the start.
        end: the first time that is not written.
        direction: ``sent`` or ``received``; empty: both.
        command: the command that frames must have; empty: all frames, and noise.
    """

    format: FileFormat
    begin: float = float("-inf")
    end: float = float("inf")
    direction: str = ""
    command: str = ""

    @classmethod
    def of(cls, query: Mapping[str, str]) -> Selection:
        """Return the selection that the query of an address describes.

        Raises:
            UsageError: a value is not allowed.
        """
        format, direction = query.get("format", "pcapng"), query.get("direction", "")
        if format not in get_args(FileFormat):
            raise UsageError("format", format, ", ".join(get_args(FileFormat)))
        if direction not in ("", "sent", "received"):
            raise UsageError("direction", direction, "sent, received, or nothing for both")
        begin, end = _seconds(query, "begin", "-inf"), _seconds(query, "end", "inf")
        chosen = cast(FileFormat, format)
        return cls(chosen, begin, end, direction, query.get("command", ""))

    def choose(self, entries: Iterable[Entry], describer: Describer) -> list[Entry]:
        """Return the entries to write; remarks are never written."""
        return [
            entry
            for entry in entries
            if entry.data
            and self.begin <= entry.time < self.end
            and self.direction in ("", entry.direction)
            and (not self.command or _command(entry, describer) == self.command)
        ]


class WrittenFile(NamedTuple):
    """A file for the browser to keep."""

    name: str
    data: bytes


def written(
    entries: Sequence[Entry], format: FileFormat, interface: Interface, start_ns: int
) -> WrittenFile:
    """Return a file with the entries; ``start_ns`` is the time 0 of the entries, since 1970.

    Several tables are put into one archive.

    Raises:
        UsageError: a package is missing; the text says how to install it.
    """
    recording = _recording(entries, interface, start_ns)
    if format == "pcapng":
        return WrittenFile("studio.pcapng", recording)
    with tempfile.TemporaryDirectory(prefix="cobotwire-studio-") as folder:
        source, out = Path(folder) / "studio.pcapng", Path(folder) / "out"
        source.write_bytes(recording)
        plan = ExportPlan(
            str(out), InstalledEditions(interface.edition), format=cast(FormatName, format)
        )
        write(plan, Inputs.find([str(source)]))
        return _archive(sorted(path for path in out.rglob("*") if path.is_file()), format)


def _archive(paths: Sequence[Path], format: str) -> WrittenFile:
    if len(paths) == 1:
        return WrittenFile(paths[0].name, paths[0].read_bytes())
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in paths:
            archive.write(path, path.name)
    return WrittenFile(f"studio-{format}.zip", packed.getvalue())


def _recording(entries: Sequence[Entry], interface: Interface, start_ns: int) -> bytes:
    file = io.BytesIO()
    writer = CaptureWriter(file)
    index = writer.interface(interface)
    for entry in entries:
        time_ns = start_ns + round(entry.time * 1e9)
        noise = entry.finding is not None
        reason = entry.finding.reason if entry.finding is not None else ""
        kind: Literal["noise", "frame"] = "noise" if noise else "frame"
        writer.packet(Packet(time_ns, entry.direction, entry.data, kind, reason, interface=index))
    writer.finish()
    return file.getvalue()


def _command(entry: Entry, describer: Describer) -> str:
    message, _ = describer.read(entry)
    return "" if message is None else message.command.name


def _seconds(query: Mapping[str, str], name: str, default: str) -> float:
    try:
        return float(query.get(name) or default)
    except ValueError:
        raise UsageError(name, query[name], "a number of seconds") from None
