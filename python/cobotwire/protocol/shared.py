"""Compute what depends only on a table once, for all clients of the edition.

A codec of an edition takes half a megabyte and ten milliseconds. A program with a thousand arms has
a thousand clients, but few editions.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from cobotwire.protocol.table import Table

Result = TypeVar("Result")

# Results for this many tables are kept: the number of editions. Limits make further tables.
KEPT = 16


def once_per_table(function: Callable[[Table], Result]) -> Callable[[Table], Result]:
    """Return a function that keeps its results for the tables that were used last.

    Tables are told apart by identity: comparing two of them takes longer than most functions. The
    result is shared by threads, so it must not be changed.
    """
    recent: deque[tuple[Table, Result]] = deque(maxlen=KEPT)

    def shared(table: Table) -> Result:
        # A copy, since another thread may add to it meanwhile.
        for known, result in tuple(recent):
            if known is table:
                return result
        result = function(table)
        recent.appendleft((table, result))
        return result

    return shared
