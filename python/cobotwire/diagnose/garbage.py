"""Classify bytes in which no recogniser found anything: NULs, a wrong baud rate, or unknown.

A receiver that is at least twice as fast as the sender samples each bit several times: the start
bit fills the low bits with zeros, and the ones are consecutive. ``78 80 78``, seen at a wrong rate,
is an example. So a byte *fits* if it is even, not zero, and its ones are consecutive. Of the 256
byte values, 28 fit. Small numbers, which protocols often send, fit more often. If the receiver is
the slower one, garbage looks like data. Hence the finding is a guess.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import ClassVar

from cobotwire.codec.interface import NoiseReason
from cobotwire.diagnose.findings import SHOWN, Finding, Span
from cobotwire.diagnose.nuls import nuls

# Unrecognised bytes are reported in pieces of this size.
PIECE_LIMIT = 256

# Fewer bytes prove nothing; real garbage has some bytes that do not fit.
GARBAGE_MINIMUM = 3
GARBAGE_SHARE = 0.75
# Every protocol sends small numbers; at least half of the bytes must fit and be larger.
SMALL = 0x40

_FITTING = frozenset(
    block << shift
    for width in range(1, 8)
    for block in [(1 << width) - 1]
    for shift in range(1, 9 - width)
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Garbage(Finding):
    """Bytes that may have been sent at a lower baud rate; this is a guess.

    ``fitting`` bytes look stretched; ``chance`` is the probability for random bytes.
    """

    fitting: int
    chance: float
    kind: ClassVar[str] = "garbage"
    advice: ClassVar[str] = (
        "the baud rate may be wrong: try --baudrate 1000000 or --baudrate 115200"
    )
    piece: ClassVar[int | None] = PIECE_LIMIT
    summary_prefix: ClassVar[str] = "perhaps a wrong baud rate: "
    summary_noun: ClassVar[str] = "segment"

    def describe(self) -> str:
        """Describe the guess."""
        return (
            f"perhaps a wrong baud rate: {self.fitting} of {len(self.data)} bytes look "
            f"stretched (probability for random bytes: {self.chance:.2g})"
        )

    def example(self) -> str:
        """Return the first bytes."""
        return self.data[: SHOWN // 4].hex(" ")


@dataclass(frozen=True, slots=True, kw_only=True)
class Unrecognised(Finding):
    """Bytes in which no recogniser found anything, and that do not look stretched."""

    kind: ClassVar[str] = "unrecognised"
    advice: ClassVar[str] = (
        "record the traffic (--record FILE), and inspect it with cobotwire decode FILE"
    )
    piece: ClassVar[int | None] = PIECE_LIMIT

    def summarize(self, count: int, size: int) -> str:
        """Describe the number of bytes."""
        return f"{size} unrecognised byte{'s' * (size != 1)}"


def classify(spans: tuple[Span, ...], reason: NoiseReason) -> Finding:
    """Return the finding that fits best."""
    data = b"".join(span.data for span in spans)
    if not any(data):
        return nuls(spans, reason)
    fitting = sum(byte in _FITTING for byte in data)
    large = sum(byte in _FITTING and byte >= SMALL for byte in data)
    stretched = fitting >= GARBAGE_SHARE * len(data) and 2 * large >= len(data)
    if len(data) < GARBAGE_MINIMUM or not stretched:
        return Unrecognised(spans=spans, reason=reason)
    return Garbage(spans=spans, reason=reason, fitting=fitting, chance=_chance(len(data), fitting))


def _chance(size: int, fitting: int) -> float:
    """Return the probability that at least ``fitting`` of ``size`` random bytes fit."""
    share = len(_FITTING) / 256
    return sum(
        comb(size, count) * share**count * (1 - share) ** (size - count)
        for count in range(fitting, size + 1)
    )
