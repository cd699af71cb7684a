"""The result of testing a target: how much was compared, and what differed."""

from __future__ import annotations

from typing import NamedTuple


class Comparison(NamedTuple):
    """How much was compared for an edition, and every difference in words.

    ``refused`` counts the vectors with values or bytes that must be refused.
    """

    vectors: int
    fields: int
    differences: list[str]
    refused: int = 0


class ToolMissing(Exception):
    """A tool is not installed; the message names it and how to install it."""
