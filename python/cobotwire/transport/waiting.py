"""Wait until a descriptor is ready; read and write it in one call where the native module can."""

from __future__ import annotations

import select
import sys
from collections.abc import Callable
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.transport.alarm import Alarm, new_alarm

# On macOS, poll() refuses terminals; Windows has no poll(). There select() waits, which fails for
# descriptors from this number on.
SELECTABLE = 1024
POLLS = hasattr(select, "poll")
POLLS_TERMINALS = POLLS and sys.platform != "darwin"


class NativeCalls(NamedTuple):
    """Functions of the native module that do what :class:`DescriptorTransport` does in Python.

    ``read_within(descriptor, timeout, alarm)`` waits and reads. ``write_now(descriptor, data)``
    writes what is taken at once.
    """

    read_within: Callable[[int, float, int], bytes | None]
    write_now: Callable[[int, bytes], int]


def native_calls() -> NativeCalls | None:
    """Return the native functions; None if Python waits, as with the reference codec."""
    if not POLLS_TERMINALS or codecs.chosen() != "native":
        return None
    from cobotwire import _native

    return NativeCalls(_native.read_within, _native.write_now)


def has_room(transport: object) -> bool:
    """Return whether a transport takes some bytes now, as far as the system tells."""
    # Checking for the protocol takes longer than all of this.
    fileno = getattr(transport, "fileno", None)
    try:
        descriptor = None if fileno is None else fileno()
        return descriptor is None or is_ready(descriptor, 0, writing=True)
    except (OSError, ValueError):
        # The transport is closed, or cannot be waited for; a write reports which.
        return True


class Waiter:
    """Waits until a descriptor can be read or written, the time is over, or :meth:`wake`.

    The first wait that takes time opens what :meth:`wake` needs: one descriptor on Linux, two
    elsewhere. So a transport that an event loop watches needs none.
    """

    def __init__(self) -> None:
        self._woken = False
        # One alarm, or two if two threads began to wait at once: adding to a list is atomic.
        self._alarms: list[Alarm] = []

    def wait(self, descriptor: int, timeout: float, *, writing: bool = False) -> bool:
        """Return whether it is ready or gone; a read or write tells which.

        A timeout of zero or less does not wait. After :meth:`wake` every wait ends at once; its
        result means nothing then.
        """
        if timeout <= 0:
            return is_ready(descriptor, 0, writing=writing)
        alarm = self.alarm()
        return alarm is None or is_ready(descriptor, timeout, writing=writing, or_readable=alarm)

    def alarm(self) -> int | None:
        """Return the descriptor that :meth:`wake` makes readable.

        None if :meth:`wake` was called already.
        """
        if not self._alarms:
            # Two threads that begin at once open two alarms; both wait for the first.
            self._alarms.append(new_alarm())
        # Checked after the alarm exists: a wake() from now on finds it.
        return None if self._woken else self._alarms[0].descriptor

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
        # No warning: a transport that was not closed gives one itself.
        self.close()


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
