"""Write a count with its noun."""

from __future__ import annotations


def counted(number: int, noun: str) -> str:
    """Return a count with its noun, in the plural if need be: ``1 byte``, ``2 bytes``."""
    if number == 1:
        return f"{number} {noun}"
    return f"{number} {noun}{'es' if noun.endswith('h') else 's'}"
