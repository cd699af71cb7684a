"""Read archives of captures of any size with all processors, or with a Dask cluster.

See ``docs/archives.md``. :func:`scan` returns the rows of one message for queries: a Dask
DataFrame, delayed Arrow tables, or Arrow tables made by local threads. :func:`export` writes files,
as :func:`cobotwire.capture.export.write` does, but one for each piece of the archive. Neither the
rows nor the counts depend on the pieces or on the number of workers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal, get_args

from cobotwire.capture.archive.dask_engine import DaskEngine
from cobotwire.capture.archive.engine import Engine, ThreadEngine
from cobotwire.capture.export import Editions, ExportPlan, Inputs, Message, Report
from cobotwire.capture.export.extras import needed
from cobotwire.codec.interface import Listening
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Direction

if TYPE_CHECKING:
    from cobotwire.capture.archive.scanning import Scan

__all__ = [
    "ENGINES",
    "PIECE_BYTES",
    "DaskEngine",
    "Engine",
    "EngineName",
    "ThreadEngine",
    "choose_engine",
    "export",
    "scan",
]

EngineName = Literal["threads", "dask"]
ENGINES: tuple[EngineName, ...] = get_args(EngineName)

# The size of a piece. A task holds the rows of one, which take some four times as much memory.
PIECE_BYTES = 64 << 20


def scan(
    urls: str | Sequence[str],
    editions: Editions,
    command: str,
    direction: Direction = "reply",
    *,
    listening: Listening | None = None,
    wide: bool = True,
    begin_ns: int | None = None,
    end_ns: int | None = None,
    piece_bytes: int = PIECE_BYTES,
) -> Scan:
    """Return the rows of one message of an archive; nothing is decoded yet.

    Args:
        urls: files, folders, patterns or fsspec URLs of recordings (pcapng) and of raw bytes.
        editions: finds the editions of the inputs, as in an :class:`ExportPlan`.
        command: the name of the command.
        direction: its reply or its request.
        listening: what raw bytes hold; by default only messages of ``direction``.
        wide: whether a field of several numbers becomes several columns.
        begin_ns: the first time, in nanoseconds since 1970 (UTC); only for recordings.
        end_ns: the first time that is no longer included.
        piece_bytes: the size of the pieces into which raw bytes are divided.

    Raises:
        UsageError: an argument names nothing, the edition has no such message, or a package is
            missing.
        LinkError: a store cannot be listed, or an input cannot be read.
    """
    needed("pyarrow", "arrow", "reading an archive")
    from cobotwire.capture.archive.pieces import divide
    from cobotwire.capture.archive.scanning import Scan

    plan = ExportPlan(
        "",
        editions,
        commands=(command,),
        direction=listening or direction,
        begin_ns=begin_ns,
        end_ns=end_ns,
        wide=wide,
    )
    inputs = Inputs.find([urls] if isinstance(urls, str) else urls)
    # Raises an error here if the default edition has no such message.
    editions.codec("").decode_columns(b"").rows(command, direction)
    return Scan(Message(command, direction), plan, divide(inputs, piece_bytes))


def export(
    plan: ExportPlan,
    inputs: Inputs,
    engine: Engine | None = None,
    *,
    piece_bytes: int = PIECE_BYTES,
    progress: Callable[[int], None] = lambda size: None,
) -> Report:
    """Export inputs with many workers, by default with threads; return what was read and written.

    The output is a folder or an fsspec URL, and all workers must be able to write there. The files
    are parts: ``get_angles.reply-00012.parquet``, numbered in the order of the inputs. They get
    their names when all are complete; an exception leaves no files. ``progress`` gets the number of
    stored bytes of each piece that is complete.

    Raises:
        UsageError: the plan cannot be written, the output holds files, an input cannot be opened,
            or a package is missing.
        LinkError: an input cannot be read to its end, or the scheduler does not answer.
        OutputError: a file cannot be written.
    """
    needed("pyarrow", "arrow", "export")
    from cobotwire.capture.archive import exporting

    return exporting.export(plan, inputs, engine or ThreadEngine(), piece_bytes, progress)


def choose_engine(
    name: EngineName | None, scheduler: str | None = None, workers: int | None = None
) -> Engine | None:
    """Return the engine of a name; None without a name.

    Raises:
        UsageError: a scheduler or a number of workers is given to an engine that takes none, or
            Dask is not installed.
    """
    if scheduler is not None and name != "dask":
        message = "a scheduler needs a Dask cluster: add --engine dask"
        raise UsageError("scheduler", scheduler, message=message)
    if workers is not None and (name is None or scheduler is not None):
        message = "the cluster has its own workers: leave out --workers"
        if name is None:
            message = "--workers needs --engine threads or --engine dask"
        raise UsageError("workers", workers, message=message)
    if name is None:
        return None
    return ThreadEngine(workers) if name == "threads" else DaskEngine(scheduler, workers)
