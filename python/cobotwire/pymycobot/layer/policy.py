"""Settings of the layer for unchanged programs: how calls fail, and which arms are open."""

from __future__ import annotations

import weakref
from typing import Literal

from cobotwire.client import Client


class Policy:
    """How the arms of a program are opened; ``cobotwire run`` sets it."""

    def __init__(self) -> None:
        self.errors: Literal["raise", "return"] = "raise"
        self._arms: weakref.WeakSet[Client] = weakref.WeakSet()

    def opened(self, arm: Client) -> None:
        """Note an arm that a program has opened."""
        self._arms.add(arm)

    def arms(self) -> list[Client]:
        """Return the arms that are still in use."""
        return list(self._arms)


policy = Policy()
