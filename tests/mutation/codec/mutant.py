"""A codec with one fault, as data."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cobotwire.conformance.codec import Implementation
from cobotwire.protocol.table import Table
from mutation.tables import Place


class CodecMutant(NamedTuple):
    """``make`` returns a new one. ``place`` says where a table is wrong, ``table`` is that table.

    ``command`` is where to look first; empty: anywhere.
    """

    kind: str
    id: str
    command: str
    make: Callable[[], Implementation]
    place: Place | None = None
    table: Table | None = None
