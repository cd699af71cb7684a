"""Record one transport to a capture file of its own."""

from __future__ import annotations

import os
from contextlib import suppress
from types import TracebackType
from typing import Literal, Self

from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.recorder import Recorder, TrafficItem
from cobotwire.capture.writer import CaptureWriter
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import CaptureError
from cobotwire.transport import forks


class Recording:
    """A recorder that owns its file.

    ``TappedTransport(open_transport(url, baudrate), recording.record)`` passes it each chunk when
    the chunk is read or written. As the ``trace`` of a client it also gets every byte, but only
    when the frame is complete.

    Attributes:
        incomplete: why bytes are missing, if they are; then the file is not marked as finished.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        codec: Codec | None,
        *,
        url: str = "",
        baudrate: int = 0,
        application: str = "cobotwire",
    ) -> None:
        """Create the file.

        Args:
            path: the file; an existing file is not overwritten.
            codec: cuts the bytes into frames; None records the chunks as they come.
            url: the port, for the readers of the capture.
            baudrate: bits a second, for the readers of the capture.
            application: the name of the program that writes the capture.

        Raises:
            UsageError: the file exists already, or it cannot be created.
        """
        try:
            self._file = open(path, "xb")  # noqa: SIM115  (closed by close())
        except (OSError, ValueError) as error:
            raise unusable_file("record", path, error) from None
        self._name, self.incomplete = str(path), ""
        try:
            self._writer = CaptureWriter(self._file, application)
            self._recorder = Recorder(
                self._writer, codec, url=url, baudrate=baudrate, name=self._name
            )
        except OSError as error:
            # If the disk is full, remove the empty file: the next attempt would not overwrite it.
            with suppress(OSError):
                self._file.close()
            with suppress(OSError):
                os.unlink(path)
            raise unusable_file("record", path, error) from None
        forks.watch(self)

    def __call__(self, item: TrafficItem) -> None:
        """Record one item of a client's traffic."""
        self._recorder(item)

    def record(self, direction: Literal["sent", "received"], data: bytes, at: float) -> None:
        """Record a chunk that was read or written at ``at``, in ``time.monotonic()`` seconds."""
        self._recorder.record(direction, data, at)

    @property
    def failure(self) -> OSError | ValueError | None:
        """The error that ended the recording; None if there was none."""
        return self._recorder.failure

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Finish the file. Closing twice is harmless.

        Raises:
            CaptureError: a write failed, so the recording is incomplete.
        """
        if self._file.closed:
            return
        try:
            self._recorder.close()
            if self.incomplete:
                detail = f"the recording is incomplete: {self.incomplete}"
                raise CaptureError(self._name, self._writer.size, detail)
            self._writer.finish()
        except OSError as error:
            raise CaptureError(
                self._name, self._writer.size, f"the recording could not be finished: {error}"
            ) from error
        finally:
            # On a full disk closing fails too; the error is already raised.
            with suppress(OSError):
                self._file.close()

    def leave_to_parent(self) -> None:
        """Close a forked child's copy of the file, and write nothing to it."""
        # close() would write the buffer, which may hold half a block if the fork came within a
        # write.
        self._file.raw.close()
