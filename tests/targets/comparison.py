"""The result of testing a target: how much was compared, and what differed."""

from __future__ import annotations

from typing import NamedTuple


class Comparison(NamedTuple):
    """How much was compared for an edition, and every difference in words."""

    vectors: int
    fields: int
    differences: list[str]


class ToolMissing(Exception):
    """A tool is not installed; the message names it and how to install it."""
