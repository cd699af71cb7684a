"""A codec that is broken in one place, as data."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cobotwire.conformance.codec import Implementation
from cobotwire.table import Table
from mutation.tables import Place


class CodecMutant(NamedTuple):
    """``make`` gives a new one. ``place`` says where a table is at fault, ``table`` has the fault.

    ``command`` is where to look first; empty: anywhere.
    """

    kind: str
    id: str
    command: str
    make: Callable[[], Implementation]
    place: Place | None = None
    table: Table | None = None
