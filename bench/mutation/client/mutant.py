"""A client that is broken in one place: what it sends, and when."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.conformance.client import Told

# Longer than any answer takes, and than a session waits for a late one.
PAUSE = 1.2


class Sent(NamedTuple):
    """A write, so many seconds after the one before it."""

    after: float
    data: bytes


class ClientMutant(NamedTuple):
    """``told`` is what the client should send; ``lost`` answers never reach it."""

    kind: str
    id: str
    told: tuple[Told, ...]
    writes: tuple[Sent, ...]
    lost: bool = False
