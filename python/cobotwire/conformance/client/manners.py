"""How an arm's answers reach a client: after a moment, and on purpose not always well."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.conformance.client.past import Heard
from cobotwire.errors import UsageError

MISDEEDS = ("lost", "late", "split", "merged", "noise", "twice")
# Longer than most clients wait, shorter than a late reply was seen to take.
LATE_SECONDS = 0.6
PAUSE_SECONDS = 0.05
SERVO_PACKET = bytes.fromhex("FF FF 01 04 00 FF 07 F4")


class _Part(NamedTuple):
    due: float
    number: int
    data: bytes
    # The request that is answered when this part has gone out.
    answers: tuple[Heard, ...]


class Manners:
    """Takes answers, gives bytes when they are due."""

    def __init__(self, delay: float, misdeeds: Sequence[str] = (), every: int = 3) -> None:
        """Answer after ``delay`` seconds, and every ``every``-th time badly, in turns.

        Raises:
            UsageError: a misdeed that is none, or ``every`` below 1.
        """
        for misdeed in misdeeds:
            if misdeed not in MISDEEDS:
                raise UsageError("misbehave", misdeed, f"some of {', '.join(MISDEEDS)}")
        if every < 1:
            raise UsageError("every", every, "a whole number from 1")
        self._delay = delay
        self._misdeeds = list(misdeeds)
        self._every = every
        self._answers = 0
        self._parts: list[_Part] = []
        self._count = 0
        self._held: tuple[bytes, tuple[Heard, ...]] = (b"", ())

    @property
    def due(self) -> float | None:
        """When the next bytes go out."""
        return self._parts[0].due if self._parts else None

    def take(self, heard: Heard) -> None:
        """Answer a request in a while."""
        if not heard.answer:
            return
        self._answers += 1
        bad = self._misdeeds and self._answers % self._every == 0
        turn = self._answers // self._every - 1
        misdeed = self._misdeeds[turn % len(self._misdeeds)] if bad else ""
        due, data = heard.at + self._delay, heard.answer
        if misdeed == "merged":
            self._held = (self._held[0] + data, (*self._held[1], heard))
            return
        if misdeed != "lost":
            held, others = self._held
            self._held = (b"", ())
            self._deliver(misdeed, due, held + data, (*others, heard))

    def _deliver(self, misdeed: str, due: float, data: bytes, answers: tuple[Heard, ...]) -> None:
        if misdeed == "split":
            self._put(due, data[: len(data) // 2], ())
            self._put(due + PAUSE_SECONDS, data[len(data) // 2 :], answers)
        elif misdeed == "late":
            self._put(due + LATE_SECONDS, data, answers)
        elif misdeed == "noise":
            self._put(due, SERVO_PACKET + data, answers)
        else:
            self._put(due, data * 2 if misdeed == "twice" else data, answers)

    def _put(self, due: float, data: bytes, answers: tuple[Heard, ...]) -> None:
        self._count += 1
        heapq.heappush(self._parts, _Part(due, self._count, data, answers))

    def give(self, now: float) -> bytes:
        """What is due by now."""
        said = b""
        while self._parts and self._parts[0].due <= now:
            part = heapq.heappop(self._parts)
            for heard in part.answers:
                heard.answered_at = now
            said += part.data
        return said
