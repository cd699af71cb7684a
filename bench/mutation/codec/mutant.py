"""A codec that is broken in one place, as data."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cobotwire.conformance.codec import Implementation
from mutation.tables import Place
from cobotwire.table import Table


class CodecMutant(NamedTuple):
    """``make`` gives a new one. Where a table is at fault, ``place`` says where and ``table`` has it.

    ``command`` is where to look first; empty: anywhere.
    """

    kind: str
    id: str
    command: str
    make: Callable[[], Implementation]
    place: Place | None = None
    table: Table | None = None
