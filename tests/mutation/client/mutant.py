"""A client with one fault: what it sends, and when."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.conformance.client import ScriptLine

# Longer than any reply takes, and longer than a session waits for a late one.
PAUSE = 1.2


class Sent(NamedTuple):
    """A write, ``after`` seconds after the previous one."""

    after: float
    data: bytes


class ClientMutant(NamedTuple):
    """A client with a fault. ``script`` is what it should send; if ``lost``, it gets no reply."""

    kind: str
    id: str
    script: tuple[ScriptLine, ...]
    writes: tuple[Sent, ...]
    lost: bool = False
