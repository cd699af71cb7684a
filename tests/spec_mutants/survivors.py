"""The mutants that may survive, each with the reason."""

from __future__ import annotations

import re

# A pattern of the kind and title, and the reason.
REASONS = (
    (
        r"\S*\.samples .*",
        "which legal values are harmless is this project's own judgement; no source states it",
    ),
    (
        r"\S*\.silence_ms .*",
        "field notes report pauses of 100 ms; how much longer to wait is this project's own choice",
    ),
)


def accepted(kind: str, title: str) -> str:
    """Return why a mutant may survive; empty if it may not."""
    found = (why for pattern, why in REASONS if re.fullmatch(pattern, f"{kind} {title}"))
    return next(found, "")
