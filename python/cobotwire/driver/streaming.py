"""Streams of samples, for threads: :meth:`cobotwire.driver.Driver.stream` makes them."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType
from typing import Self

from cobotwire.driver.streamed import Streamed
from cobotwire.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.session import Question, Request
from cobotwire.session.sample import Reading, Sample, StreamReport
from cobotwire.session.sampling import Sampler
from cobotwire.transport.timing import Times

# The longest sleep, after which it is looked whether another thread has closed the stream.
LOOK_SECONDS = 0.05


class Stream:
    """Samples, one a turn of a ``for`` loop; see :mod:`cobotwire.session.sampling` for when.

    It polls in the consumer's thread, when the consumer wants a sample and not else: there is no
    thread and no queue behind it. Breaking off the loop leaves nothing to be cleared up, nor does
    Ctrl-C, and the stream can be gone on with. Other threads may use the arm meanwhile.
    """

    def __init__(
        self,
        ask: Callable[[Request], Question],
        queries: tuple[Streamed, ...],
        rate: float,
        times: Times,
    ) -> None:
        self._ask = ask
        self._now, self._pause = times.now, times.sleep
        self._queries = queries
        self._sampler = Sampler(tuple(one.query for one in queries), rate)
        self._closed_at: float | None = None

    @property
    def report(self) -> StreamReport:
        """Samples, missed ones and the rate reached, until now or until it was closed."""
        now = self._now() if self._closed_at is None else self._closed_at
        return self._sampler.report(now)

    def close(self) -> None:
        """End the loop and the report, from any thread. Closing twice is harmless."""
        if self._closed_at is None:
            self._closed_at = self._now()

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> Sample:
        """Wait for the next slot and ask; a slot without an answer is counted, and the next tried.

        Raises:
            StopIteration: the stream is closed.
            LinkError: the link is gone, and the stream closed.
            UsageError: another thread waits for the next sample of this stream.
        """
        while self._closed_at is None:
            at = self._sampler.plan(self._now())
            try:
                if not self._sleep(at):
                    break
                readings = self._readings()
            except BaseException as error:
                self._sampler.interrupted(self._now())
                if isinstance(error, LinkError):
                    self.close()
                raise
            if readings is not None:
                return self._sampler.answered(readings, self._now())
            self._sampler.unanswered(self._now())
        raise StopIteration

    def _sleep(self, until: float) -> bool:
        """Wait; False if the stream was closed meanwhile."""
        while (left := until - self._now()) > 0 and self._closed_at is None:
            self._pause(min(left, LOOK_SECONDS))
        return self._closed_at is None

    def _readings(self) -> list[Reading] | None:
        """Ask every query; None as soon as one is not answered."""
        readings = []
        for one in self._queries:
            try:
                question = self._ask(one.request)
            except (ReplyTimeout, ProtocolError):
                return None
            readings.append(one.reading(question))
        return readings

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()
