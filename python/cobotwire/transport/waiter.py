"""Wait until a descriptor can be read or written, or until another thread ends the wait."""

from __future__ import annotations

import io
import os
import select
import socket
import sys
from contextlib import suppress
from typing import Protocol

# macOS's poll() refuses terminals, and Windows has none. There select() waits, which fails for
# descriptors from this number on.
SELECTABLE = 1024
POLLS = hasattr(select, "poll")
POLLS_TERMINALS = POLLS and sys.platform != "darwin"


class Waiter:
    """Waits until a descriptor can be read or written, the time is over, or :meth:`wake`.

    The first wait that takes time opens what :meth:`wake` needs: one descriptor on Linux, two
    elsewhere. So a transport that an event loop watches needs none.
    """

    def __init__(self) -> None:
        self._woken = False
        # At most one. A list, since adding to it is atomic: two threads may begin to wait at once.
        self._alarms: list[_Alarm] = []

    def wait(self, descriptor: int, timeout: float, *, writing: bool = False) -> bool:
        """Return whether it is ready, or gone: reading or writing it tells that.

        A timeout of zero or less does not wait. After :meth:`wake` every wait ends at once; its
        result means nothing then.
        """
        if timeout <= 0:
            return is_ready(descriptor, 0, writing=writing)
        alarm = self._alarm()
        # Checked after the alarm exists: a wake() from now on finds it.
        if self._woken:
            return True
        return is_ready(descriptor, timeout, writing=writing, or_readable=alarm.fileno())

    def wake(self) -> None:
        """End the wait, and every later one."""
        self._woken = True
        for alarm in self._alarms:
            alarm.set()

    def close(self) -> None:
        """Close what the waits opened. Closing twice is harmless."""
        self._woken = True
        for alarm in self._alarms:
            alarm.close()

    def __del__(self) -> None:
        # A transport that was not closed warns for itself; the alarm is not the user's concern.
        self.close()

    def _alarm(self) -> _Alarm:
        if not self._alarms:
            self._alarms.append(_EventAlarm() if hasattr(os, "eventfd") else _PairAlarm())
        # Two threads that begin at once open two alarms; both wait for the first.
        return self._alarms[0]


def is_ready(
    descriptor: int, timeout: float, *, writing: bool = False, or_readable: int | None = None
) -> bool:
    """Wait until a descriptor is ready or gone, or until the one in ``or_readable`` is.

    Returns:
        False if neither is after ``timeout`` seconds.

    Raises:
        OSError, ValueError: the system cannot wait for the descriptor.
    """
    highest = descriptor if or_readable is None else max(descriptor, or_readable)
    if POLLS_TERMINALS or (POLLS and highest >= SELECTABLE):
        poll = select.poll()
        poll.register(descriptor, select.POLLOUT if writing else select.POLLIN)
        if or_readable is not None:
            poll.register(or_readable, select.POLLIN)
        # Python rounds up to whole milliseconds.
        return bool(poll.poll(max(0.0, timeout) * 1000))
    incoming = [] if or_readable is None else [or_readable]
    outgoing: list[int] = []
    (outgoing if writing else incoming).append(descriptor)
    read, write, _ = select.select(incoming, outgoing, [], max(0.0, timeout))
    return bool(read or write)


class _Alarm(Protocol):
    """A descriptor that becomes readable for good when the alarm is set."""

    def fileno(self) -> int: ...

    def set(self) -> None: ...

    def close(self) -> None: ...


class _EventAlarm:
    """An alarm of one descriptor, on Linux."""

    def __init__(self) -> None:
        # A file object, since its write() after close() fails; a bare number may be another file's.
        self._file = io.FileIO(os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC), "wb")

    def fileno(self) -> int:
        return self._file.fileno()

    def set(self) -> None:
        # A closed file raises ValueError.
        with suppress(OSError, ValueError):
            self._file.write((1).to_bytes(8, sys.byteorder))

    def close(self) -> None:
        self._file.close()


class _PairAlarm:
    """An alarm of two sockets: every platform can wait for these, but not for a pipe."""

    def __init__(self) -> None:
        self._in, self._out = socket.socketpair()
        self._out.setblocking(False)

    def fileno(self) -> int:
        return self._in.fileno()

    def set(self) -> None:
        with suppress(OSError):
            self._out.send(b"x")

    def close(self) -> None:
        self._in.close()
        self._out.close()
