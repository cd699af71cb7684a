"""What is said of one problem code."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Explanation:
    """A code: what it means, why that is a problem, how to mend it, and lines that show it.

    ``wrong`` are lines of a spec that give the code, ``right`` the same lines mended.
    """

    code: str
    means: str
    why: str
    mend: str
    wrong: str
    right: str
