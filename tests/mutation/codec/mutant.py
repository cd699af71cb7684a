"""A codec with one fault, as data."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cobotwire.conformance.codec import Implementation
from cobotwire.protocol.table import Table
from mutation.tables import Place


class CodecMutant(NamedTuple):
    """A codec with one fault; ``make`` returns a new one.

    If its table is wrong, ``table`` is that table and ``place`` the wrong part. The questions about
    ``command`` come first; if it is empty, all questions are asked in order.
    """

    kind: str
    id: str
    command: str
    make: Callable[[], Implementation]
    place: Place | None = None
    table: Table | None = None
