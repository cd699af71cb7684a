"""The explanation of a problem code."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Explanation:
    """A code: what it means, why that is a problem, how to fix it, and lines that show it.

    ``wrong`` are lines of a spec that cause the problem, ``right`` the corrected lines.
    """

    code: str
    means: str
    why: str
    fix: str
    wrong: str
    right: str
