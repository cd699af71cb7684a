"""Settings of the layer for unchanged programs: how calls fail, and which arms are open."""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal, NamedTuple

from cobotwire.client import Client


class _Opened(NamedTuple):
    """An arm that a program has opened, the object that opened it, and the port."""

    arm: Client
    owner: weakref.ref[object]
    port: object


class Policy:
    """How the arms of a program are opened; ``cobotwire run`` sets it."""

    def __init__(self) -> None:
        self.errors: Literal["raise", "return"] = "raise"
        # None: no program runs.
        self._opened: list[_Opened] | None = None

    @contextmanager
    def running(self) -> Iterator[None]:
        """Keep the arms that a program opens in the block, also those that it no longer refers to.

        Their motions go on, so they must be stopped if the program fails.
        """
        before, self._opened = self._opened, []
        try:
            yield
        finally:
            self._opened = before

    def opened(self, arm: Client, owner: object, port: object) -> None:
        """Note an arm that a program has opened."""
        if self._opened is not None:
            self._opened.append(_Opened(arm, weakref.ref(owner), port))

    def closed(self, arm: Client) -> None:
        """Forget an arm that a program has closed."""
        if self._opened is not None:
            self._opened[:] = [each for each in self._opened if each.arm is not arm]

    def free(self, port: object) -> None:
        """Close an arm to which a program no longer refers, because it opens the port again."""
        for each in [*(self._opened or ())]:
            if each.port == port and each.owner() is None:
                each.arm.close()
                self.closed(each.arm)

    def arms(self) -> list[Client]:
        """Return the arms that the program has opened and not closed."""
        return [each.arm for each in self._opened or ()]


policy = Policy()
