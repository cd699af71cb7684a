"""Classify bytes in which nothing was recognised: NULs, a wrong baud rate, or unknown.

A receiver that is at least twice as fast as the sender samples each bit several times: the start
bit fills the low bits with zeros, and the ones are consecutive. ``78 80 78``, seen at a wrong rate,
is an example. So a byte *fits* if it is even, not zero, and its ones are consecutive. Of random
bytes 28 in 256 fit; of the small numbers that protocols often send, many more. If the receiver is
the slower one, garbage looks like data. Hence the finding is a guess.
"""

from __future__ import annotations

from math import comb

from cobotwire.diagnose.findings import REBOOT_NULS, Finding, Garbage, Nuls, Unrecognised
from cobotwire.diagnose.residue import Residue, Verdict, Wait

# This many NULs in a row are a finding of their own.
NUL_MINIMUM = 4
NUL_LIMIT = 4096
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


def recognise_nuls(residue: Residue, at: int) -> Verdict:
    """Recognise a run of NULs at ``at``, in pieces of ``NUL_LIMIT``."""
    limit, final = residue.stretch(at)
    rest = residue.data[at : min(limit, at + NUL_LIMIT)]
    count = len(rest) - len(rest.lstrip(b"\0"))
    if at + count == limit and count < NUL_LIMIT and not final:
        return Wait.WAIT
    return _nuls(residue, at, at + count) if count >= NUL_MINIMUM else None


def _nuls(residue: Residue, start: int, end: int) -> Nuls:
    return Nuls(
        spans=residue.spans(start, end),
        reason=residue.reason(start),
        count=end - start,
        reboot=end - start >= REBOOT_NULS,
    )


def classify(residue: Residue, start: int, end: int) -> Finding:
    """Return the best finding for bytes in which nothing was recognised."""
    data = residue.data[start:end]
    if not any(data):
        return _nuls(residue, start, end)
    spans, reason = residue.spans(start, end), residue.reason(start)
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
