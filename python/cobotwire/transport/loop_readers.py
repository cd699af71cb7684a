"""Watch the descriptors of many transports for one event loop.

A loop makes several objects and calls for each descriptor that is ready. So the loop itself watches
only the first few descriptors, and one epoll that watches all others.
"""

from __future__ import annotations

import asyncio
import select
import sys
from collections.abc import Callable
from contextlib import suppress
from contextvars import Context, copy_context
from weakref import WeakValueDictionary

# The loop itself watches this many descriptors. If there are few, each turn serves one or two, and
# a second epoll costs more than it saves.
FEW = 64
# The most descriptors that are served in one turn of the loop.
MOST_EVENTS = 256


class LoopReaders:
    """The descriptors that one event loop reads; every method is called in its thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        # The descriptors that the loop watches itself.
        self._few: set[int] = set()
        self._calls: dict[int, tuple[Context, Callable[[], object]]] = {}
        self._epoll: select.epoll | None = None

    def add(self, descriptor: int, call: Callable[[], object]) -> None:
        """Have ``call`` called whenever a descriptor can be read, or is gone.

        Raises:
            NotImplementedError: the loop cannot watch descriptors.
            OSError: the system cannot watch this one.
        """
        if len(self._few) >= FEW and self._has_epoll():
            assert self._epoll is not None, "it was checked"
            self._epoll.register(descriptor, select.EPOLLIN)
            self._calls[descriptor] = copy_context(), call
        else:
            self._loop.add_reader(descriptor, call)
            self._few.add(descriptor)

    def remove(self, descriptor: int) -> None:
        """Stop watching a descriptor, which must still be open."""
        if descriptor in self._few:
            self._few.remove(descriptor)
            self._loop.remove_reader(descriptor)
        elif self._calls.pop(descriptor, None) and self._epoll is not None:
            self._epoll.unregister(descriptor)

    def _has_epoll(self) -> bool:
        if self._epoll is None and sys.platform == "linux":
            # The process may have too many descriptors.
            with suppress(OSError):
                epoll = select.epoll()
                self._loop.add_reader(epoll.fileno(), self._run)
                self._epoll = epoll
        return self._epoll is not None

    def _run(self) -> None:
        """Make the calls of the descriptors that are ready."""
        assert self._epoll is not None, "the loop watches it"
        calls = self._calls
        for descriptor, _ in self._epoll.poll(0, MOST_EVENTS):
            # An earlier call may have closed it.
            found = calls.get(descriptor)
            if found is not None:
                # The loop reports an error; its next turn serves those that are still ready.
                context, call = found
                context.run(call)


# By the id of the loop, which the readers keep alive.
_known: WeakValueDictionary[int, LoopReaders] = WeakValueDictionary()


def readers_of(loop: asyncio.AbstractEventLoop) -> LoopReaders:
    """Return the readers of a loop, which exist as long as a caller keeps them."""
    readers = _known.get(id(loop))
    if readers is None:
        readers = _known[id(loop)] = LoopReaders(loop)
    return readers
