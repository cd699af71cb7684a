"""What can be said of bytes in which nothing was recognised.

A receiver that is at least twice as fast as the sender sees each bit several times over: the start
bit fills the low bits with zeros, and ones come in one block. ``78 80 78``, seen on a line at the
wrong rate, is of that kind. So a byte *fits* if it is even, not zero, and its ones are one block.
Of random bytes 28 in 256 do; of the small numbers that protocols are full of, many. Where the
receiver is the slower one, nothing tells garbage from data. Hence the finding is a guess.
"""

from __future__ import annotations

from math import comb

from cobotwire.diagnose.findings import REBOOT_NULS, Finding, Garbage, Nuls, Unrecognised
from cobotwire.diagnose.residue import Residue, Verdict, Wait

# So many NULs in a row are told apart from what they stand in.
NUL_MINIMUM = 4
NUL_LIMIT = 4096
# What cannot be recognised is reported in pieces of that size.
PIECE_LIMIT = 256

# Fewer bytes say nothing; a real line's garbage is mixed with some that do not fit.
GARBAGE_MINIMUM = 3
GARBAGE_SHARE = 0.75
# Smaller numbers come in any protocol; at least half of the bytes must fit and be larger.
SMALL = 0x40

_FITTING = frozenset(
    block << shift
    for width in range(1, 8)
    for block in [(1 << width) - 1]
    for shift in range(1, 9 - width)
)


def recognise_nuls(residue: Residue, at: int) -> Verdict:
    """A run of NULs at ``at``, in pieces of ``NUL_LIMIT``."""
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
    """The best word for bytes in which nothing was recognised."""
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
    """How often at least ``fitting`` of ``size`` random bytes fit."""
    share = len(_FITTING) / 256
    return sum(
        comb(size, count) * share**count * (1 - share) ** (size - count)
        for count in range(fitting, size + 1)
    )
