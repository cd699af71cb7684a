"""Read pairs of hex digits, with or without spaces, commas or 0x."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from cobotwire.protocol.errors import UnreadableInput

_HEX = re.compile(rb"(?:[\s,;:]|0[xX]|[0-9A-Fa-f]{2})*")
_SEPARATORS = re.compile(rb"0[xX]|[\s,;:]+")


def hex_arguments(arguments: Sequence[str]) -> bytes | None:
    """Return the bytes if the arguments are pairs of hex digits, else None."""
    text = " ".join(arguments).encode(errors="replace")
    return _unhex(text) if is_hex(text) else None


def is_hex(text: bytes, cut: bool = False) -> bool:
    """Return whether a text is hex. If it is ``cut``, the last pair may lack its second digit."""
    return len(text) - _end_of_hex(text) <= cut


def read_hex(blocks: Iterator[bytes], name: str) -> Iterator[bytes]:
    """Yield the bytes of hex text; ``name`` stands for the file in messages."""
    place, rest = 0, b""
    for block in blocks:
        text = rest + block
        end = _end_of_hex(text)
        if len(text) - end > 1:
            raise _not_hex(name, place + end)
        yield _unhex(text[:end])
        place, rest = place + end, text[end:]
    if rest:
        raise _not_hex(name, place)


def _not_hex(name: str, place: int) -> UnreadableInput:
    detail = f"is not hex: byte {place} of {name} is not a pair of hex digits"
    return UnreadableInput(name, f"{detail}; --raw decodes it as raw bytes")


def _end_of_hex(text: bytes) -> int:
    found = _HEX.match(text)
    assert found is not None, "the pattern matches the empty text"
    return found.end()


def _unhex(text: bytes) -> bytes:
    return bytes.fromhex(_SEPARATORS.sub(b"", text).decode("ascii"))
