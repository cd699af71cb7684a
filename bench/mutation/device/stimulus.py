"""Names for what is wrong with bytes that are no legal request."""

from __future__ import annotations

from typing import Literal, get_args

from cobotwire.table import Table

Stimulus = Literal[
    "noise", "truncated request", "bad footer", "wrong LEN", "unknown id", "illegal value"
]
STIMULI: tuple[Stimulus, ...] = get_args(Stimulus)


def kind_of(table: Table, noise: bytes) -> Stimulus:
    """What a run of noise was meant to be, as a careless parser would see it."""
    frame = table.frame
    start = noise.find(frame.header)
    rest = noise[start + frame.length_at :] if start >= 0 else b""
    if len(rest) < 2:
        return "truncated request" if start >= 0 else "noise"
    length, id = rest[0], rest[1]
    sizes = {
        layout.size for command in table.commands if command.id == id for layout in command.request
    }
    if not sizes:
        return "unknown id"
    if length not in map(frame.length, sizes):
        return "wrong LEN"
    # A whole request with another end, or one that stops before it.
    return "bad footer" if len(rest) > length else "truncated request"
