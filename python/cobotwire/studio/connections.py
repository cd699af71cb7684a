"""Decide which connections stay open: those without the token cannot keep out those with it.

If the server refused new connections instead, an attacker could hold all of them and lock everybody
out. So a new connection is always accepted. If too many have not shown the token, the one that has
been idle for longest is closed. Connections that showed the token are not among them.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from operator import attrgetter

# Connections that have not shown the token: in all, and from one address.
MOST_UNKNOWN, MOST_OF_ONE_HOST = 64, 32
# The same limit in a process that may open only few files.
LEAST_UNKNOWN = 8
# Connections with the token that are never closed for others.
MOST_KNOWN = 64
# The headers of a request must be complete within this time.
HEADER_SECONDS = 5.0


@dataclass(eq=False)
class Connection:
    """An open connection.

    Attributes:
        host: the address of the other end.
        abort: closes it at once.
        since: when it came, or when its last request began or was served.
        served: whether a request is being served.
        known: whether one of its requests had the token.
    """

    host: str
    abort: Callable[[], None]
    since: float = field(default_factory=time.monotonic)
    served: bool = False
    known: bool = False


class Connections:
    """The open connections that carry requests. WebSockets are not among them."""

    def __init__(self) -> None:
        self._open: dict[Connection, None] = {}
        self._most_unknown = MOST_UNKNOWN

    def arrive(self, connection: Connection) -> None:
        """Add a connection; if too many have not shown the token, close one of these."""
        self._open[connection] = None
        unknown = self._unknown()
        same = [each for each in unknown if each.host == connection.host]
        if MOST_OF_ONE_HOST < len(same) < len(unknown):
            self._close(same[0])
        elif len(unknown) > self._most_unknown:
            self._close(unknown[0])

    def leave(self, connection: Connection) -> None:
        """Remove a connection that was closed, or that became a WebSocket."""
        self._open.pop(connection, None)

    def begin(self, connection: Connection, known: bool) -> None:
        """Note that the headers of a request are complete, and whether they have the token."""
        connection.served, connection.since = True, time.monotonic()
        connection.known |= known and sum(each.known for each in self._open) < MOST_KNOWN

    def end(self, connection: Connection) -> None:
        """Note that a request was served."""
        connection.served, connection.since = False, time.monotonic()

    def close_overdue(self) -> None:
        """Close the connections that have waited too long for the headers of a request."""
        earliest = time.monotonic() - HEADER_SECONDS
        for connection in list(self._open):
            if not connection.served and connection.since < earliest:
                self._close(connection)

    def make_room(self) -> None:
        """Close half of those without the token, and keep fewer: no more files can be opened."""
        unknown = self._unknown()
        self._most_unknown = max(LEAST_UNKNOWN, len(unknown) // 2)
        for connection in unknown[: -self._most_unknown]:
            self._close(connection)

    def _unknown(self) -> list[Connection]:
        """Return the connections without the token; the one that was idle for longest is first."""
        # Those that are being served are included: a client can hold back a body like a header.
        return sorted([each for each in self._open if not each.known], key=attrgetter("since"))

    def _close(self, connection: Connection) -> None:
        self.leave(connection)
        connection.abort()
