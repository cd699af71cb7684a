"""A stream's schedule: whatever the arm and the consumer do, its laws hold."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import UsageError
from cobotwire.session.sample import Reading, Sample
from cobotwire.session.sampling import Sampler

# Quarters of a millisecond and periods that are powers of two: times are exact, so laws are too.
TICK = 2.0**-12
RATES = st.sampled_from([0.5, 1.0, 8.0, 64.0, 512.0])
TIMES = st.one_of(st.just(0), st.integers(0, 100), st.integers(0, 40_000))
STEPS = st.lists(
    st.tuples(
        TIMES,  # the consumer takes so long to come
        TIMES,  # to wake up from the sleep
        TIMES,  # until the question could be sent
        TIMES,  # until its answer came
        st.sampled_from(["answered", "answered", "answered", "unanswered", "interrupted"]),
    ),
    max_size=40,
)


def play(sampler: Sampler, start: float, steps: list[tuple[int, int, int, int, str]]) -> float:
    """Go through the steps and check the laws after each; gives the time at the end."""
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
        asked = at + (sleep + hold) * TICK
        now = asked + wait * TICK
        if outcome == "answered":
            samples.append(sampler.answered([Reading(None, asked, now)], now))
        elif outcome == "unanswered":
            sampler.unanswered(now)
            unanswered += 1
        else:
            sampler.interrupted(now)
        report = sampler.report(now)
        assert report.samples == len(samples)
        assert report.unanswered == unanswered
        # Every slot that has passed is a sample, or is missed for one reason; none is both. The
        # last one may be in use since half a period before its moment.
        assert -0.5 <= report.slots - (now - started) / period <= 1.5
        assert sampler.report(now) == report
    assert [sample.number for sample in samples] == list(range(len(samples)))
    for one, other in pairwise(samples):
        assert one.slot < other.slot
        assert one.answered_at <= other.asked_at
        assert other.asked_at - one.asked_at >= period / 2
    for sample in samples:
        assert started is not None
        assert abs(sample.asked_at - started - sample.slot * period) <= period / 2
    return now


@given(RATES, st.integers(0, 1000), STEPS)
def test_no_sample_twice_none_out_of_order_no_bursts_and_the_counts_add_up(
    rate: float, start: int, steps: list[tuple[int, int, int, int, str]]
) -> None:
    play(Sampler(("get_angles",), rate), float(start), steps)


@given(RATES, STEPS)
def test_a_quick_line_and_a_quick_consumer_miss_nothing(
    rate: float, steps: list[tuple[int, int, int, int, str]]
) -> None:
    sampler = Sampler(("get_angles",), rate)
    quick = [(0, 0, 0, 1, "answered") for _ in steps]
    now = play(sampler, 0.0, quick)
    report = sampler.report(now)
    assert (report.missed, report.samples) == (0, len(steps))
    assert report.reached == (rate if steps else 0.0)


def test_who_is_to_blame_for_a_missed_slot() -> None:
    sampler = Sampler(("get_angles",), 10.0)
    assert sampler.plan(100.0) == 100.0
    # The line takes 0.32 s: slots 1 and 2 pass. The consumer takes until 0.78: so do 3 to 7.
    sampler.answered([Reading(1, 100.0, 100.32)], 100.32)
    assert sampler.plan(100.78) == pytest.approx(100.8)
    report = sampler.report(100.78)
    assert (report.samples, report.overrun, report.unread) == (1, 2, 5)
    assert "1 samples at 1.2 of 10 Hz" in str(report)


def test_a_line_that_needs_a_little_longer_than_a_period_is_used_nearly_fully() -> None:
    sampler = Sampler(("get_angles",), 50.0)
    now = 0.0
    for _ in range(1000):
        asked = sampler.plan(now)
        now = asked + 0.021
        sampler.answered([Reading(None, asked, now)], now)
    assert 45 < sampler.report(now).reached < 1 / 0.021


def test_a_stream_has_one_consumer() -> None:
    sampler = Sampler(("get_angles",), 10.0)
    sampler.plan(0.0)
    with pytest.raises(UsageError, match="one consumer"):
        sampler.plan(0.1)


@pytest.mark.parametrize("rate", [0, -1, 1001, float("nan"), "10", True, None])
def test_a_rate_is_a_number(rate: object) -> None:
    with pytest.raises(UsageError, match="rate is"):
        Sampler((), rate)  # type: ignore[arg-type]  # what the test is about


def test_a_sample_is_looked_into_by_query() -> None:
    readings = (Reading(1, 0.0, 0.1), Reading(2, 0.1, 0.3))
    sample = Sample(0, 0, ("get_angles", ("get_encoder", 2)), readings)
    assert (sample["get_angles"], sample["get_encoder", 2]) == sample.values == (1, 2)
    assert sample.reading("get_encoder", 2).answered_at == sample.answered_at == 0.3
    assert sample.asked_at == 0.0
    with pytest.raises(KeyError):
        sample["get_coords"]
