"""The test cases for clients, in the order in which each request is checked."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.conformance.client.groups import frames, requests
from cobotwire.conformance.client.history import History, Received
from cobotwire.conformance.client.script import SCRIPT
from cobotwire.conformance.suite import Group, Suite
from cobotwire.conformance.tally import Observation

# Checks a received message against those that were received before it.
Check = Callable[[History, Received], Iterator[Observation]]

# Groups that need no script: their bodies check everything that is received.
WITHOUT_SCRIPT: tuple[Group[Check], ...] = (
    frames.FRAMES,
    frames.INTERLEAVED_WRITES,
    frames.TEXTS,
    requests.RESENDING,
    requests.POWER,
    requests.WAITING,
    requests.LATE_REPLIES,
    frames.VALUES,
)
SUITE: Suite[Check | None] = Suite("client", (*WITHOUT_SCRIPT, SCRIPT))
