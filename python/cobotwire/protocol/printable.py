"""Make foreign text printable: text that a peer, a file or another program chose."""

from __future__ import annotations


def printable(text: str) -> str:
    r"""Return the text with an escape, such as ``\x1b``, for each character that is not printable.

    Unescaped control characters could move the cursor or change the colour, a line end could start
    a forged line, a bidirectional override could reverse the rest of a line, and a lone surrogate
    cannot be encoded.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else repr(each)[1:-1] for each in text)
