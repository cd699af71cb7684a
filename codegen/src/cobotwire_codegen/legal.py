"""Decides which characters the strings of a spec may contain.

This is the only such rule: ``load`` applies it to every value and every key of every file. Names
have further rules, in ``language/names.py``.
"""

from __future__ import annotations


def odd_character(text: str) -> str:
    """Return the first character that a spec may not contain, in words; empty without one.

    Visible characters, spaces, line feeds and tabs are legal. All others are not: control
    characters (a terminal executes them), invisible and bidirectional formats (they make a reviewer
    see another text) and lone surrogates (they have no encoding).
    """
    if text.isprintable():
        return ""
    odd = next((letter for letter in text if not _legal(letter)), None)
    return "" if odd is None else f"U+{ord(odd):04X}, which cannot be printed"


def _legal(letter: str) -> bool:
    return letter.isprintable() or letter in "\n\t"


def visible(text: str) -> str:
    """Return text for a message, with an escape for every character that cannot be printed."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
        for letter in text
    )
