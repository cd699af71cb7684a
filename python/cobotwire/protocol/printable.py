"""Make foreign text printable: text that a peer, a file or another program chose."""

from __future__ import annotations


def printable(text: str) -> str:
    r"""Return the text with an escape, such as ``\x1b``, for each character that is not printable.

    Shown raw, control characters could move the cursor or colour what follows, a line end could
    begin a forged line, bidirectional overrides reverse the rest of a line, and lone surrogates
    cannot be encoded at all.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else repr(each)[1:-1] for each in text)
