"""What a device keeps while malformed requests are sent: the state that they must not change."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

from cobotwire.conformance.hex_text import shown
from cobotwire.protocol.messages import Reply, Request


@dataclass(frozen=True, slots=True)
class Malformed:
    """A malformed request that was sent: what it is, its bytes, and what sends it again."""

    what: str
    data: bytes
    again: Callable[[], object]

    def __str__(self) -> str:
        return f"{self.what} ({shown(self.data)})"


class Comparison(Protocol):
    """Compares the state with what it was before the first malformed request."""

    def next_query(self, other_than: int) -> Request[Any] | None:
        """Return the query that is compared next, of another id; None if there is none."""
        ...

    def check(self, sent: Malformed, reply: Reply[Any] | None = None) -> str:
        """Compare one value; return what has changed, empty if nothing has."""
        ...

    def check_all(self) -> Iterator[str]:
        """Compare all values; yield what has changed."""
        ...

    def close(self) -> None:
        """Restore what was set for the comparison."""
        ...
