"""The pipe from the forwarder to the watching process: it never makes the forwarder wait."""

from __future__ import annotations

import os
import select
from collections.abc import Iterator
from contextlib import suppress
from struct import Struct
from typing import Literal, NamedTuple

try:
    import fcntl
except ModuleNotFoundError:  # Windows
    fcntl = None  # type: ignore[assignment]

Kind = Literal["sent", "received", "held", "note", "dropped"]
KINDS: tuple[Kind, ...] = ("sent", "received", "held", "note", "dropped")
HEAD = Struct("<BdH")
# The system takes a write of up to this size as a whole, or not at all.
PIECE = getattr(select, "PIPE_BUF", 512) - HEAD.size
# The size of the pipe, if the system permits it: more than 30 s of continuous traffic at 115,200
# baud in both directions.
PIPE_SIZE = 1 << 20


class Copy(NamedTuple):
    """A note of what the forwarder did.

    ``sent`` was written to the arm and ``received`` read from it; ``held`` was not forwarded;
    ``note`` is a text; ``dropped`` is the number of bytes that were not copied.
    """

    kind: Kind
    time: float
    data: bytes


class Copies:
    """The forwarder's end of the pipe."""

    def __init__(self, descriptor: int) -> None:
        os.set_blocking(descriptor, False)
        with suppress(AttributeError, OSError):
            fcntl.fcntl(descriptor, fcntl.F_SETPIPE_SZ, PIPE_SIZE)
        self._descriptor = descriptor
        # How many bytes were dropped and not yet reported to the reader.
        self._dropped = 0

    def put(self, kind: Kind, data: bytes, time: float) -> None:
        """Copy ``data``; if the reader is too slow, drop it, and report later how many bytes."""
        for start in range(0, len(data), PIECE):
            piece = data[start : start + PIECE]
            if self._dropped and self._write("dropped", b"%d" % self._dropped, time):
                self._dropped = 0
            if self._dropped or not self._write(kind, piece, time):
                self._dropped += len(piece)

    def _write(self, kind: Kind, data: bytes, time: float) -> bool:
        try:
            os.write(self._descriptor, HEAD.pack(KINDS.index(kind), time, len(data)) + data)
        except OSError:
            # The pipe is full, or its reader is gone.
            return False
        return True

    def close(self) -> None:
        """Close the pipe. Wait up to a second to report the bytes that were dropped last."""
        if self._dropped:
            select.select([], [self._descriptor], [], 1.0)
            self._write("dropped", b"%d" % self._dropped, 0.0)
        os.close(self._descriptor)


class CopyReader:
    """The watching process's end of the pipe."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> Iterator[Copy]:
        """Take what was read from the pipe; yield the complete copies."""
        data, at = self._rest + data, 0
        while len(data) - at >= HEAD.size:
            kind, time, size = HEAD.unpack_from(data, at)
            end = at + HEAD.size + size
            if end > len(data):
                break
            yield Copy(KINDS[kind], time, data[at + HEAD.size : end])
            at = end
        self._rest = data[at:]
