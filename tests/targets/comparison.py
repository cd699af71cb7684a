"""What the test of a target says of it: how much was compared, and what differed."""

from __future__ import annotations

from typing import NamedTuple


class Comparison(NamedTuple):
    """How much was compared for an edition, and every difference in words."""

    vectors: int
    fields: int
    differences: list[str]


class ToolMissing(Exception):
    """The real tool is not on this machine; the text says which, and how to get it."""
