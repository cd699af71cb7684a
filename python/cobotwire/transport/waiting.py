"""Waiting for a descriptor, in a way that another thread can end."""

from __future__ import annotations

import select
import socket
from contextlib import suppress

# From this number of open files on, select() fails. Below, it is preferred to poll(), whose time
# goes by whole milliseconds.
SELECTABLE = 1024


class Waiter:
    """Waits until a descriptor can be read or written, the time is over, or :meth:`wake`."""

    def __init__(self) -> None:
        # A pair of sockets and no pipe: these can be waited for on every platform.
        self._ear, self._mouth = socket.socketpair()
        self._mouth.setblocking(False)

    def wait(self, descriptor: int, timeout: float, *, writing: bool = False) -> bool:
        """Whether it is ready; also if it is gone, since to read or write is what tells that.

        A timeout at or below zero looks without waiting. After :meth:`wake` every wait ends at
        once; what it gives then means nothing.
        """
        timeout = max(0.0, timeout)
        if descriptor < SELECTABLE or not hasattr(select, "poll"):
            incoming: list[int | socket.socket] = [self._ear]
            outgoing: list[int] = []
            if writing:
                outgoing.append(descriptor)
            else:
                incoming.append(descriptor)
            read, write, _ = select.select(incoming, outgoing, [], timeout)
            return bool(read or write)
        poll = select.poll()
        poll.register(descriptor, select.POLLOUT if writing else select.POLLIN)
        poll.register(self._ear, select.POLLIN)
        return bool(poll.poll(timeout * 1000))

    def wake(self) -> None:
        """End the wait, and every later one."""
        with suppress(OSError):
            self._mouth.send(b"x")

    def close(self) -> None:
        """Give the pair back. Closing twice is harmless."""
        self._ear.close()
        self._mouth.close()

    def __del__(self) -> None:
        # A link that nobody closed warns of itself where it should; the pair is not the user's.
        self.close()
