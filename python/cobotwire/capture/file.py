"""A capture file for one line, opened and closed with the recording."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

from cobotwire.capture.recorder import Moment, Recorder
from cobotwire.capture.writer import CaptureWriter
from cobotwire.codec.interface import Codec
from cobotwire.errors import CaptureError, UsageError


class Recording:
    """A recorder with a file of its own.

    ``TappedLink(open_link(url, baudrate), recording.record)`` gives it everything as it passes. As
    the ``trace`` of a driver it has every byte too, but at the time when its frame was whole.
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
        """Make the file.

        Args:
            path: where; there must be nothing yet, as a recording is not overwritten.
            codec: by whose edition packets are cut; None leaves the chunks as they come.
            url: the port, for who reads the capture.
            baudrate: bits a second, likewise.
            application: what the capture says wrote it.

        Raises:
            UsageError: the file is there already, or cannot be made.
        """
        try:
            self._file = Path(path).open("xb")  # noqa: SIM115  (closed by close())
        except FileExistsError:
            raise UsageError("record", str(path), "a file that is not there yet") from None
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise UsageError("record", str(path), f"a file that can be made ({reason})") from None
        self._name = str(path)
        self._writer = CaptureWriter(self._file, application)
        self._recorder = Recorder(self._writer, codec, url=url, baudrate=baudrate, name=self._name)

    def __call__(self, moment: Moment) -> None:
        """Record what a driver tells."""
        self._recorder(moment)

    def record(self, direction: Literal["sent", "heard"], data: bytes, at: float) -> None:
        """Record a chunk as it was read or written at a ``time.monotonic()`` second."""
        self._recorder.record(direction, data, at)

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
        """End the recording in order. Closing twice is harmless.

        Raises:
            CaptureError: a write has failed, and the recording ends early.
        """
        if self._file.closed:
            return
        try:
            self._recorder.close()
            self._writer.finish()
        except OSError as error:
            raise CaptureError(self._name, self._writer.size, f"not finished: {error}") from error
        finally:
            # What a full disk did not take does not get in here either.
            with suppress(OSError):
                self._file.close()
