"""Classify bytes that are not a legal request."""

from __future__ import annotations

from typing import Literal, get_args

from cobotwire.protocol.table import Table

Stimulus = Literal[
    "noise", "truncated request", "bad footer", "wrong LEN", "unknown id", "illegal value"
]
STIMULI: tuple[Stimulus, ...] = get_args(Stimulus)


def kind_of(table: Table, noise: bytes) -> Stimulus:
    """Return what kind of malformed request a span of noise is, as a simple parser sees it."""
    frame = table.frame
    start = noise.find(frame.header)
    rest = noise[start + frame.length_at :] if start >= 0 else b""
    if len(rest) < 2:
        return "truncated request" if start >= 0 else "noise"
    length, id = rest[0], rest[1]
    sizes = {
        variant.size
        for command in table.commands
        if command.id == id
        for variant in command.request
    }
    if not sizes:
        return "unknown id"
    if length not in map(frame.length, sizes):
        return "wrong LEN"
    # The request is complete but ends with another byte, or it stops before its footer.
    return "bad footer" if len(rest) > length else "truncated request"
