"""Live sources of targets: functions, and iterators that a thread reads."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeGuard

from cobotwire.protocol.errors import UsageError
from cobotwire.session.paths import Source, Target, Waypoint

# A sequence is a path; an iterator or a function gives live targets.
Targets = Sequence[Target | Waypoint] | Iterable[Target] | Callable[[], Target | None]


class Called(Source):
    """A function that returns the newest target, or None if there is no new one.

    It ends the path by raising StopIteration.
    """

    def __init__(self, function: Callable[[], Target | None]) -> None:
        self._function = function

    def take(self) -> list[Target]:
        """Return the target that the function returns now, if any."""
        try:
            target = self._function()
        except StopIteration:
            self.exhausted = True
            return []
        return [] if target is None else [target]


class Mailbox(Source):
    """Targets that another thread or task has put in."""

    def __init__(self) -> None:
        self._targets: deque[Target] = deque()
        self._error: BaseException | None = None
        self._ended = False
        self.closed = False

    def put(self, target: Target) -> None:
        """Add a target."""
        self._targets.append(target)

    def end(self, error: BaseException | None = None) -> None:
        """Note that no further target comes; ``error`` is the reason, if there is one."""
        self._error = error
        self._ended = True

    def take(self) -> list[Target]:
        """Return the targets that came since the last call; raise the error that ended them."""
        # Read the end before the targets, so that targets that came before it are not lost.
        self.exhausted = self._ended
        targets = [self._targets.popleft() for _ in range(len(self._targets))]
        if self.exhausted and self._error is not None:
            raise self._error
        return targets

    def close(self) -> None:
        """Stop accepting targets."""
        self.closed = True


def read_aside(source: Iterable[Target]) -> Mailbox:
    """Read an iterable in a thread, as fast as it yields targets.

    When the mailbox is closed, the thread ends with the next target; it does not keep the program
    from ending.
    """
    mailbox = Mailbox()

    def read() -> None:
        try:
            for target in source:
                if mailbox.closed:
                    return
                mailbox.put(target)
            mailbox.end()
        except BaseException as error:
            mailbox.end(error)

    threading.Thread(target=read, name="targets", daemon=True).start()
    return mailbox


def is_path(path: Any) -> TypeGuard[Sequence[Target | Waypoint]]:
    """Return whether a path is known as a whole: a sequence, or an array."""
    return hasattr(path, "__len__") and hasattr(path, "__getitem__") and not isinstance(path, str)


def source_of(path: Any) -> Source:
    """Return a function or an iterable as a source.

    Raises:
        UsageError: it is neither.
    """
    if callable(path):
        return Called(path)
    if isinstance(path, Iterable) and not isinstance(path, str | bytes | dict):
        return read_aside(path)
    raise UsageError("path", path, "targets in a sequence or an iterator, or a function")
