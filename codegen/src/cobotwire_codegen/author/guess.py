"""Guesses what the bytes of an unknown message mean."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

# A measured 16-bit number rarely changes by more than this between two frames.
_SMOOTH = 2500
_FEW = 8


@dataclass(frozen=True, slots=True)
class Guess:
    """A guess about some bytes of the data; ``first`` counts from 0."""

    first: int
    width: int
    kind: str
    says: str


def guess(payloads: Sequence[bytes]) -> list[Guess]:
    """Return guesses for every byte of messages of one length, in order of arrival."""
    return list(_guesses(payloads)) if payloads else []


def _guesses(payloads: Sequence[bytes]) -> Iterator[Guess]:
    position, length = 0, len(payloads[0])
    while position < length:
        found = (
            _text(payloads, position, length)
            or _word(payloads, position, length)
            or _byte([payload[position] for payload in payloads], position)
        )
        yield found
        position += found.width


def _text(payloads: Sequence[bytes], first: int, length: int) -> Guess | None:
    end = first
    while end < length and all(32 <= payload[end] < 127 for payload in payloads):
        end += 1
    text = payloads[0][first:end].decode("ascii", "replace")
    if end - first < 4 or sum(map(str.isalpha, text)) < 3:
        return None
    return Guess(first, end - first, "text", f"ASCII, such as {text!r}")


def _word(payloads: Sequence[bytes], first: int, length: int) -> Guess | None:
    # If a word starts at the second byte, that byte is a high byte, so no word starts at the first.
    if not _smooth(payloads, first, length) or _smooth(payloads, first + 1, length):
        return None
    words = [_signed(payload, first) for payload in payloads]
    says = f"a big-endian word that varies smoothly, {min(words)}..{max(words)}: scaled?"
    return Guess(first, 2, "word", says)


def _smooth(payloads: Sequence[bytes], first: int, length: int) -> bool:
    """Return whether two bytes change like one number, with carries into the high byte."""
    if first + 2 > length:
        return False
    high = {payload[first] for payload in payloads}
    low = {payload[first + 1] for payload in payloads}
    jumps = [abs(b - a) for a, b in pairwise(_signed(payload, first) for payload in payloads)]
    varied = len(high) > 1 and len(low) > max(len(high), _FEW)
    # A flag before a byte looks like a word that jumps by 256 each time.
    flag = len(high) == 2 and min(jumps) > 128
    return varied and max(jumps) < _SMOOTH and not flag


def _signed(payload: bytes, first: int) -> int:
    return int.from_bytes(payload[first : first + 2], "big", signed=True)


def _byte(values: list[int], first: int) -> Guess:
    distinct = sorted(set(values))
    steps = {(b - a) % 256 for a, b in pairwise(values)}
    listed = ", ".join(map(str, distinct[:_FEW]))
    if len(distinct) == 1:
        return Guess(first, 1, "constant", f"always {distinct[0]}")
    if steps == {1} and len(values) > 2:
        return Guess(first, 1, "counter", "counts up by one")
    if distinct == [0, 1]:
        return Guess(first, 1, "flag", "0 or 1: a flag?")
    if len(distinct) <= _FEW and distinct[-1] < 32 and len(values) >= 2 * len(distinct):
        return Guess(first, 1, "enum", f"one of {listed}: an enum?")
    return Guess(first, 1, "byte", f"{distinct[0]}..{distinct[-1]}")
