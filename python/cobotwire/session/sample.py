"""What a stream yields: samples, and a report on its periods."""

from __future__ import annotations

from typing import Any, Generic, NamedTuple, TypeVar

from cobotwire.protocol.messages import Request

Result = TypeVar("Result")


class Reading(NamedTuple, Generic[Result]):
    """The result of one request, and when it was read.

    Times are seconds of ``time.monotonic()``, unless the transport has a clock of its own. The arm
    measured the value between ``requested_at`` and ``replied_at``.
    """

    value: Result
    """What the client's method for the request returns."""
    requested_at: float
    """The time just before the request was written."""
    replied_at: float
    """When its reply was read."""


class Sample:  # not a tuple: its keys are requests
    """The results of a stream's requests in one of its periods.

    ``sample[GetAngles()]`` is the result of one request, with its precise type.

    Attributes:
        number: counts the samples of a stream, from 0.
        period: counts the periods of a stream, from 0, also those without a sample.
        requests: the requests of the stream, in the order of sending.
        readings: a reading for each request.
    """

    __slots__ = ("number", "period", "requests", "readings")  # noqa: RUF023  (as __init__ takes them)
    number: int
    period: int
    requests: tuple[Request[Any], ...]
    readings: tuple[Reading[Any], ...]

    def __init__(
        self,
        number: int,
        period: int,
        requests: tuple[Request[Any], ...],
        readings: tuple[Reading[Any], ...],
    ) -> None:
        for name, value in zip(self.__slots__, (number, period, requests, readings)):
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a sample is read-only; cannot set {name}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sample) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def __reduce__(self) -> tuple[type[Sample], tuple[object, ...]]:
        return Sample, self._key()

    def _key(self) -> tuple[object, ...]:
        return self.number, self.period, self.requests, self.readings

    def __repr__(self) -> str:
        return f"Sample(number={self.number}, period={self.period}, values={self.values})"

    @property
    def requested_at(self) -> float:
        """The time just before its first request was written, in seconds."""
        return self.readings[0].requested_at

    @property
    def replied_at(self) -> float:
        """When its last reply was read, in seconds."""
        return self.readings[-1].replied_at

    @property
    def values(self) -> tuple[Any, ...]:
        """The results, in the order of the requests."""
        return tuple(reading.value for reading in self.readings)

    def reading(self, request: Request[Result]) -> Reading[Result]:
        """Return the result of one request with its times.

        Raises:
            KeyError: the stream does not send that request.
        """
        # Not a dict: arguments may be lists, and there are few requests.
        for known, reading in zip(self.requests, self.readings):
            if known == request:
                return reading
        raise KeyError(request)

    def __getitem__(self, request: Request[Result]) -> Result:
        return self.reading(request).value


class StreamReport(NamedTuple):
    """The periods of a stream so far: each has a sample, or is missed for one of three reasons."""

    rate: float
    """Periods a second: what was requested."""
    samples: int
    """Periods with a sample."""
    unanswered: int
    """Missed: a request had no reply in time, or one that the edition does not allow."""
    overrun: int
    """Missed: the line or the process was still busy. The rate is more than they can do."""
    unread: int
    """Missed: the consumer requested no sample in time, so nothing was sent."""

    @property
    def missed(self) -> int:
        """Periods without a sample."""
        return self.unanswered + self.overrun + self.unread

    @property
    def periods(self) -> int:
        """Periods that have passed, or are in use."""
        return self.samples + self.missed

    @property
    def reached(self) -> float:
        """Samples a second: the rate, less the share of periods that were missed."""
        return self.rate * self.samples / self.periods if self.periods else 0.0

    def __str__(self) -> str:
        return (
            f"{self.samples} samples at {self.reached:.1f} of {self.rate:g} Hz; missed: "
            f"{self.unanswered} unanswered, {self.overrun} overrun, {self.unread} unread"
        )
