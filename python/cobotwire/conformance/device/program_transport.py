"""Transports to a program that the run has started; they report at once that it has ended."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import NoReturn

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import Transport
from cobotwire.transport.descriptor import DescriptorTransport

# The slowest rate at which a program reads, in bits per second.
SLOWEST = 9600
# How often a read checks whether the program still runs, in seconds.
CHECKS = 0.05
# How long a program may still run after it closed its side of the transport, in seconds.
CLOSING = 0.5


class DescriptorEnd(DescriptorTransport):
    """A transport over an open descriptor: our end of a socket pair, pseudo-terminal or pipe."""

    def __init__(self, descriptor: int, url: str) -> None:
        self._given, self._opened = descriptor, False
        super().__init__(url, SLOWEST)

    def _connect(self) -> int:
        os.set_blocking(self._given, False)
        self._opened = True
        return self._given

    def _release(self) -> None:
        if self._opened:
            self._opened = False
            os.close(self._given)

    def _end_of_data(self) -> str:
        return "the other end is closed"


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
