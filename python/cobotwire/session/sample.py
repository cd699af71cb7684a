"""What a stream gives: samples, and the report of how it went."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

# A query's name; or a tuple of its name and its arguments, for queries that take some.
Query = str | tuple[str, *tuple[Any, ...]]


class Reading(NamedTuple):
    """The answer to one query, as its method gives it.

    Times are those of ``time.monotonic()``, unless the link has a clock of its own.
    """

    value: Any
    asked_at: float
    """When the question was written, in seconds."""
    answered_at: float
    """When its reply was read, in seconds: what the value tells, was so between the two."""


@dataclass(frozen=True, slots=True)
class Sample:
    """What the queries of a stream answered in one of its slots.

    ``sample["get_angles"]`` and ``sample["get_encoder", 2]`` are the values of single queries.

    Attributes:
        number: counts the samples of a stream, from 0.
        slot: counts the periods of a stream, from 0, those without a sample too.
        queries: what was asked, in this order.
        readings: a reading for each query.
    """

    number: int
    slot: int
    queries: tuple[Query, ...]
    readings: tuple[Reading, ...]

    @property
    def asked_at(self) -> float:
        """When its first question was written, in seconds of ``time.monotonic()``."""
        return self.readings[0].asked_at

    @property
    def answered_at(self) -> float:
        """When its last reply was read, in seconds of ``time.monotonic()``."""
        return self.readings[-1].answered_at

    @property
    def values(self) -> tuple[Any, ...]:
        """The answers, in the order of the queries."""
        return tuple(reading.value for reading in self.readings)

    def reading(self, *query: Any) -> Reading:
        """The answer to one query with its times: ``sample.reading("get_encoder", 2)``.

        Raises:
            KeyError: the stream does not ask that.
        """
        wanted = query[0] if len(query) == 1 else query
        # Not a dict: arguments may be lists, and there are few queries.
        for known, reading in zip(self.queries, self.readings):
            if known == wanted:
                return reading
        raise KeyError(wanted)

    def __getitem__(self, query: Query) -> Any:
        return self.reading(*query).value if isinstance(query, tuple) else self.reading(query).value


class StreamReport(NamedTuple):
    """How a stream went so far. Every slot is a sample, or is missed for one of three reasons."""

    rate: float
    """Slots a second: what was asked for."""
    samples: int
    """Slots with a sample."""
    unanswered: int
    """Missed: a question had no answer in time, or one that the edition does not allow."""
    overrun: int
    """Missed: the line or the process was still busy. The rate is more than they can do."""
    unread: int
    """Missed: the consumer had not asked for a sample by then, so the arm was not asked either."""

    @property
    def missed(self) -> int:
        """Slots without a sample."""
        return self.unanswered + self.overrun + self.unread

    @property
    def slots(self) -> int:
        """Slots that have passed, or are in use."""
        return self.samples + self.missed

    @property
    def reached(self) -> float:
        """Samples a second: the rate, less the share of slots that were missed."""
        return self.rate * self.samples / self.slots if self.slots else 0.0

    def __str__(self) -> str:
        return (
            f"{self.samples} samples at {self.reached:.1f} of {self.rate:g} Hz; missed: "
            f"{self.unanswered} unanswered, {self.overrun} overrun, {self.unread} unread"
        )
