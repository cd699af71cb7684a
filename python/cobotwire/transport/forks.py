"""Notice a fork: a child must neither use nor close the transports that its parent opened.

A forked child has copies of the parent's descriptors. If it reads them, it takes bytes from the
parent; if it shuts a connection down or wakes a wait, the parent notices. In the child, therefore,
everything that is open counts as closed; its copies are closed so that the parent does not notice.
"""

from __future__ import annotations

import os
from typing import Protocol
from weakref import WeakSet


class Inherited(Protocol):
    """An object of which a forked child has a copy."""

    def leave_to_parent(self) -> None:
        """Let go of everything that is shared with the parent; called in the child, once."""
        ...


_open: WeakSet[Inherited] = WeakSet()


def watch(thing: Inherited) -> None:
    """Call ``thing.leave_to_parent()`` in every process that is forked from this one."""
    _open.add(thing)


def opened_by_parent() -> str:
    """Return why nothing works in the child; called in ``leave_to_parent``."""
    return f"process {_pid} opened it and then forked this process: open it anew in this one"


def _in_child() -> None:
    global _pid
    for thing in list(_open):
        thing.leave_to_parent()
    _pid = os.getpid()


_pid = os.getpid()
# Windows has no fork.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_in_child)
