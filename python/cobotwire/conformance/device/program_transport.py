"""Transports to a program that the run has started; they report at once that it has ended."""

from __future__ import annotations

import os
import select
import time
from collections.abc import Callable
from typing import NoReturn

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import Transport

READ_SIZE = 4096
# A write may take this long, in seconds.
WRITING = 2.0
# How often a read checks whether the program still runs, in seconds.
CHECKS = 0.05
# How long a program that has closed its end may take to end, in seconds.
CLOSING = 0.5


class DescriptorEnd:
    """A transport over an open descriptor: our end of a socket pair or pseudo-terminal."""

    def __init__(self, descriptor: int, url: str) -> None:
        self.url = url
        self._descriptor = descriptor
        os.set_blocking(descriptor, False)

    def read(self, timeout: float) -> bytes:
        """Return the received bytes, as soon as there are any; empty after ``timeout`` seconds.

        Raises:
            LinkError: the other end is closed.
        """
        try:
            if not select.select([self._descriptor], [], [], timeout)[0]:
                return b""
            data = os.read(self._descriptor, READ_SIZE)
        except BlockingIOError:
            return b""
        except (OSError, ValueError) as error:
            raise LinkError(self.url, f"cannot be read: {error}") from error
        if not data:
            raise LinkError(self.url, "cannot be read: the other end is closed")
        return data

    def write(self, data: bytes) -> None:
        """Send all of ``data``.

        Raises:
            LinkError: the other end is closed, or takes no bytes.
        """
        while data:
            try:
                ready = select.select([], [self._descriptor], [], WRITING)[1]
                data = data[os.write(self._descriptor, data) :] if ready else data
            except BlockingIOError:
                continue
            except (OSError, ValueError) as error:
                raise LinkError(self.url, f"cannot be written: {error}") from error
            if not ready:
                raise LinkError(self.url, f"takes no bytes for {WRITING:g} s")

    def close(self) -> None:
        """Close the descriptor."""
        descriptor, self._descriptor = self._descriptor, -1
        if descriptor >= 0:
            os.close(descriptor)


class WatchedTransport:
    """A transport to a program; when the program has ended, the errors say how."""

    def __init__(self, inner: Transport, url: str, ended: Callable[[], str]) -> None:
        """Wrap a transport; ``ended`` returns how the program ended; empty while it runs."""
        self.url = url
        self._inner = inner
        self._ended = ended

    def read(self, timeout: float) -> bytes:
        """Return the received bytes, as soon as there are any; empty after ``timeout`` seconds.

        Raises:
            LinkError: the program has ended, and all that it sent was read.
        """
        until = time.monotonic() + timeout
        while True:
            # Checked before the read, so that the read returns all that the program sent.
            ended = self._ended()
            left = until - time.monotonic()
            try:
                data = self._inner.read(0.0 if ended else max(0.0, min(left, CHECKS)))
            except LinkError as error:
                self._explain(error)
            if data:
                return data
            if ended:
                raise LinkError(self.url, ended)
            if left <= CHECKS:
                return b""

    def write(self, data: bytes) -> None:
        """Send all of ``data``.

        Raises:
            LinkError: the program has ended, or does not read.
        """
        try:
            self._inner.write(data)
        except LinkError as error:
            self._explain(error)

    def close(self) -> None:
        """Close the transport."""
        self._inner.close()

    def _explain(self, error: LinkError) -> NoReturn:
        """Raise an error that says how the program ended; ``error`` if it still runs."""
        until = time.monotonic() + CLOSING
        while not (ended := self._ended()) and time.monotonic() < until:
            time.sleep(CHECKS / 5)
        if ended:
            raise LinkError(self.url, ended) from error
        raise error
