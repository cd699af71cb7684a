"""Joints and coordinates, again and again, with how well that goes."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.driver import Driver
from cobotwire.errors import ProtocolError, ReplyTimeout, UsageError
from cobotwire.health.ear import Ear
from cobotwire.table import Command, Role

# The rate that is shown is that of so many samples.
WINDOW = 10
FASTEST = 1000.0
ROLES: tuple[Role, ...] = ("joints", "coordinates")


class Sample(NamedTuple):
    """One look at the arm.

    Attributes:
        time: seconds from the beginning.
        values: what was answered, by the name of the query; None: it was not.
        rate: samples a second, reached over the last few; 0 for the first.
        unanswered: questions without a legal answer, so far.
        late: replies that came too late, so far.
        noise: bytes of noise, so far.
        diagnosis: what that noise was, in a sentence.
        error: why the last question failed that did; empty if none did in this sample.
    """

    time: float
    values: dict[str, Any]
    rate: float
    unanswered: int
    late: int
    noise: int
    diagnosis: str
    error: str


class Monitor:
    """Asks an arm for its joints and coordinates; what nobody answers does not end it."""

    def __init__(self, arm: Driver, codec: Codec, rate: float) -> None:
        """Samples a second are at most ``rate``.

        Raises:
            UsageError: the rate is not allowed.
        """
        if not 0 < rate <= FASTEST:
            raise UsageError("rate", rate, f"above 0, up to {FASTEST:g}")
        self._arm, self._rate = arm, rate
        commands = codec.table.commands
        self._commands = [c for role in ROLES for c in commands if c.role == role]
        self._ear = Ear(codec)
        self._unanswered = 0
        self._error = ""

    def samples(self, count: int | None = None) -> Iterator[Sample]:
        """So many samples; None: without end.

        Raises:
            LinkError: the link is gone.
        """
        end = self._arm.watch(self._ear)
        times: deque[float] = deque(maxlen=WINDOW)
        started = due = time.monotonic()
        taken = 0
        try:
            while count is None or taken < count:
                times.append(time.monotonic())
                yield self._sample(started, times)
                taken += 1
                # What was missed is not made up for: the arm has enough to do.
                due = max(due + 1 / self._rate, time.monotonic())
                if taken != count:
                    self._arm.listen(max(0.0, due - time.monotonic()))
        finally:
            end()

    def _sample(self, started: float, times: deque[float]) -> Sample:
        self._error = ""
        values = {command.name: self._ask(command) for command in self._commands}
        span = times[-1] - times[0]
        rate = (len(times) - 1) / span if span else 0.0
        ear = self._ear
        ear.pause()
        at = times[-1] - started
        said = str(ear.findings)
        return Sample(at, values, rate, self._unanswered, ear.late, ear.noise, said, self._error)

    def _ask(self, command: Command) -> Any:
        try:
            return getattr(self._arm, command.name)()
        except (ReplyTimeout, ProtocolError) as error:
            self._unanswered += 1
            self._error = str(error)
            return None
