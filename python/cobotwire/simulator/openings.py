"""Notice when programs open and close a device, such as a pty; by inotify, so on Linux only."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager
from struct import Struct

OPENED, CLOSED, NOTHING = 0x20, 0x8 | 0x10, 0x400
# The watch, the kind of event, two numbers; the last is the length of a name that follows.
EVENT = Struct("iIII")
READ_SIZE = 4096


class Openings:
    """Reports each opening and closing of a device, in order."""

    def __init__(self, path: str) -> None:
        """Watch ``path``.

        Raises:
            OSError: the system has no inotify, or no more watches.
        """
        library = ctypes.CDLL(None, use_errno=True)
        if not hasattr(library, "inotify_init1"):
            raise OSError("this system has no inotify")
        self._add, self._path = library.inotify_add_watch, os.fsencode(path)
        self.descriptor: int = library.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        if self.descriptor < 0:
            raise OSError(ctypes.get_errno(), "no further inotify instance")
        if self._watch(OPENED | CLOSED) < 0:
            self.close()
            raise OSError(ctypes.get_errno(), f"{path} cannot be watched")

    def read(self) -> list[bool]:
        """Return what happened since the last call: True for an opening, False for a closing."""
        try:
            data = os.read(self.descriptor, READ_SIZE)
        except BlockingIOError:
            return []
        events, start = [], 0
        while start < len(data):
            _, mask, _, length = EVENT.unpack_from(data, start)
            start += EVENT.size + length
            if mask & (OPENED | CLOSED):
                events.append(bool(mask & OPENED))
        return events

    @contextmanager
    def ignored(self) -> Iterator[None]:
        """Report nothing that happens in this block."""
        self._watch(NOTHING)
        try:
            yield
        finally:
            self._watch(OPENED | CLOSED)

    def close(self) -> None:
        """Stop watching."""
        os.close(self.descriptor)

    def _watch(self, mask: int) -> int:
        return int(self._add(self.descriptor, self._path, mask))
