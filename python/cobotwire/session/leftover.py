"""What an ended session leaves on its port, for the next session there to respect."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cobotwire.session.alignment import Part


class LateFrame(NamedTuple):
    """A request that was sent; its reply may still come before the second ``until``."""

    request: bytes
    until: float


class Leftover(NamedTuple):
    """Replies that may still come, and what the peer may hold of a request that was cut.

    Attributes:
        late: the requests of which replies are outstanding; times are those of the port's clock.
        parts: every part of a request that the peer may hold.
    """

    late: tuple[LateFrame, ...] = ()
    parts: tuple[Part, ...] = ()

    @property
    def empty(self) -> bool:
        """Whether the line is aligned and silent."""
        return not self.late and not self.parts


def merged(leftovers: Iterable[Leftover]) -> Leftover:
    """Return what several sessions left on the same port."""
    found = list(leftovers)
    return Leftover(
        tuple(late for each in found for late in each.late),
        tuple(part for each in found for part in each.parts),
    )
