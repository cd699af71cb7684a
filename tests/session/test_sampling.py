"""The laws of a stream's schedule hold for any delays of the arm and the consumer."""

from __future__ import annotations

import pickle
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import UsageError
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.messages import Request
from cobotwire.session.sample import Reading, Sample
from cobotwire.session.sampling import Sampler

GET_ANGLES: Request[Any] = TABLE.request_type("get_angles")()
encoder: Any = TABLE.request_type("get_encoder")
# Quarters of a millisecond and periods that are powers of two keep times, and so the laws, exact.
TICK = 2.0**-12
RATES = st.sampled_from([0.5, 1.0, 8.0, 64.0, 512.0])
TIMES = st.one_of(st.just(0), st.integers(0, 100), st.integers(0, 40_000))
STEPS = st.lists(
    st.tuples(
        TIMES,  # until the consumer comes
        TIMES,  # to wake up from the sleep
        TIMES,  # until the request can be sent
        TIMES,  # until its reply comes
        st.sampled_from(["answered", "answered", "answered", "unanswered", "interrupted"]),
    ),
    max_size=40,
)


def play(sampler: Sampler, start: float, steps: list[tuple[int, int, int, int, str]]) -> float:
    """Run the steps and check the laws after each; return the time at the end."""
    now = start
    period = 1 / sampler.report(now).rate
    started: float | None = None
    samples: list[Sample] = []
    unanswered = 0
    for idle, sleep, hold, wait, outcome in steps:
        now += idle * TICK
        started = now if started is None else started
        at = sampler.plan(now)
        assert at >= now
        assert at - now <= 1.5 * period
        sent_at = at + (sleep + hold) * TICK
        now = sent_at + wait * TICK
        if outcome == "answered":
            samples.append(sampler.answered([Reading(None, sent_at, now)], now))
        elif outcome == "unanswered":
            sampler.unanswered(now)
            unanswered += 1
        else:
            sampler.interrupted(now)
        report = sampler.report(now)
        assert report.samples == len(samples)
        assert report.unanswered == unanswered
        # Every period that has passed has a sample or is missed for one reason. The last one may be
        # in use since half a period before it begins.
        assert -0.5 <= report.periods - (now - started) / period <= 1.5
        assert sampler.report(now) == report
    assert [sample.number for sample in samples] == list(range(len(samples)))
    for one, other in pairwise(samples):
        assert one.period < other.period
        assert one.replied_at <= other.requested_at
        assert other.requested_at - one.requested_at >= period / 2
    for sample in samples:
        assert started is not None
        assert abs(sample.requested_at - started - sample.period * period) <= period / 2
    return now


@given(RATES, st.integers(0, 1000), STEPS)
def test_samples_arrive_once_in_order_without_bursts_and_the_counts_add_up(
    rate: float, start: int, steps: list[tuple[int, int, int, int, str]]
) -> None:
    play(Sampler((GET_ANGLES,), rate), float(start), steps)


@given(RATES, STEPS)
def test_fast_line_and_fast_consumer_miss_nothing(
    rate: float, steps: list[tuple[int, int, int, int, str]]
) -> None:
    sampler = Sampler((GET_ANGLES,), rate)
    quick = [(0, 0, 0, 1, "answered") for _ in steps]
    now = play(sampler, 0.0, quick)
    report = sampler.report(now)
    assert (report.missed, report.samples) == (0, len(steps))
    assert report.reached == (rate if steps else 0.0)


def test_missed_period_is_counted_for_line_or_consumer() -> None:
    sampler = Sampler((GET_ANGLES,), 10.0)
    assert sampler.plan(100.0) == 100.0
    # The line takes 0.32 s: periods 1 and 2 pass. The consumer takes until 0.78: 3 to 7 pass.
    sampler.answered([Reading(1, 100.0, 100.32)], 100.32)
    assert sampler.plan(100.78) == pytest.approx(100.8)
    report = sampler.report(100.78)
    assert (report.samples, report.overrun, report.unread) == (1, 2, 5)
    assert "1 samples at 1.2 of 10 Hz" in str(report)


def test_line_slightly_slower_than_the_rate_is_used_almost_completely() -> None:
    sampler = Sampler((GET_ANGLES,), 50.0)
    now = 0.0
    for _ in range(1000):
        sent_at = sampler.plan(now)
        now = sent_at + 0.021
        sampler.answered([Reading(None, sent_at, now)], now)
    assert 45 < sampler.report(now).reached < 1 / 0.021


def test_second_consumer_of_a_stream_is_rejected() -> None:
    sampler = Sampler((GET_ANGLES,), 10.0)
    sampler.plan(0.0)
    with pytest.raises(UsageError, match="one consumer"):
        sampler.plan(0.1)


@pytest.mark.parametrize("rate", [0, -1, 1001, float("nan"), "10", True, None])
def test_rate_that_is_not_a_positive_number_is_rejected(rate: object) -> None:
    with pytest.raises(UsageError, match="rate is"):
        Sampler((), rate)  # type: ignore[arg-type]  # the wrong type is intended


def test_sample_holds_the_result_of_each_request() -> None:
    readings = (Reading(1, 0.0, 0.1), Reading(2, 0.1, 0.3))
    sample = Sample(0, 0, (GET_ANGLES, encoder(2)), readings)
    assert (sample[GET_ANGLES], sample[encoder(2)]) == sample.values == (1, 2)
    assert sample.reading(encoder(2)).replied_at == sample.replied_at == 0.3
    assert sample.requested_at == 0.0
    with pytest.raises(KeyError):
        sample[encoder(1)]


def test_sample_is_a_value_that_cannot_be_changed() -> None:
    reading = Reading(1, 0.0, 0.1)
    sample = Sample(0, 3, (encoder(2),), (reading,))
    assert pickle.loads(pickle.dumps(sample)) == sample == Sample(0, 3, (encoder(2),), (reading,))
    assert sample != Sample(0, 4, (encoder(2),), (reading,))
    assert len({sample, Sample(0, 3, (encoder(2),), (reading,))}) == 1
    with pytest.raises(AttributeError, match="read-only; cannot set period"):
        sample.period = 4
