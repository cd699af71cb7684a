"""Properties of the setpoints of paths and live targets, and of when they are sent."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cobotwire import FollowFailed, PathLimits, UsageError, Waypoint
from cobotwire.codec import load
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.kinematics.jerk_limited import Bounds
from cobotwire.session.following import BUSY_SHARE, STALL_SECONDS, Follow
from cobotwire.session.motion import Outcome, Query
from cobotwire.session.paths import Pause, Send
from cobotwire.session.request import EncodedRequest, RequestEncoder
from cobotwire.session.setpoints import Live, Path, evenly

Rows = list[tuple[float, ...]]
CODEC = load(TABLE, "native")
ENCODER = RequestEncoder(CODEC)
RATE = 50.0
STEADY = Bounds((76.0,) * 3, (124.0,) * 3, (200.0,) * 3)
SUDDEN = Bounds((90.0,) * 3, (100.0,) * 3, (1000.0,) * 3)
# What sampling and rounding may add to a bound.
SLACK = 1.03
angle = st.floats(-140, 140)
triple = st.tuples(angle, angle, angle)
most = st.floats(60, 150)
bounds = st.builds(
    lambda speed, acceleration, jerk: Bounds((speed,) * 3, (acceleration,) * 3, (jerk,) * 3),
    most,
    st.floats(20, 400),
    st.floats(200, 4000),
)


def stays_within(rows: Rows, bounds: Bounds, step: float) -> None:
    """Assert that positions at even times, from rest to rest, obey the bounds."""
    rows = [rows[0]] * 3 + rows + [rows[-1]] * 3
    for allowed in bounds:
        rows = [tuple((b - a) / step for a, b in zip(*pair)) for pair in pairwise(rows)]
        for axis, limit in zip(zip(*rows), allowed):
            assert max(map(abs, axis)) <= limit * SLACK + 1e-6


@settings(max_examples=15)
@given(triple, st.lists(triple, min_size=1, max_size=4), bounds)
def test_path_leads_from_the_start_to_the_last_target_within_the_bounds(
    start: tuple[float, ...], targets: list[tuple[float, ...]], bounds: Bounds
) -> None:
    path = Path(start, [(target, None) for target in targets], evenly, bounds, RATE)
    rows = [path.at(tick)[0] for tick in range(path.ticks + 1)]
    assert rows[0] == pytest.approx(start, abs=1e-6)
    assert rows[-1] == pytest.approx(targets[-1], abs=1e-6)
    stays_within(rows, bounds, 1 / RATE)
    # The path passes each point within the distance that the arm moves in two ticks.
    for target in targets:
        assert min(math.dist(target, row) for row in rows) <= 2 * max(bounds.speed) / RATE


@settings(max_examples=25)
@given(triple, st.lists(triple, min_size=1, max_size=4), bounds, st.floats(0.05, 5))
def test_path_with_times_is_at_its_points_in_time_or_is_refused(
    start: tuple[float, ...], targets: list[tuple[float, ...]], bounds: Bounds, gap: float
) -> None:
    points = [(target, gap * (number + 1)) for number, target in enumerate(targets)]
    # Without bounds the motion is the same.
    free = Path(start, points, evenly, Bounds(*[(1e9,) * 3] * 3), RATE)
    assert free.seconds == pytest.approx(points[-1][1])
    for target, time in points:
        assert free.at(time * RATE)[0] == pytest.approx(target, abs=1e-6)
    try:
        path = Path(start, points, evenly, bounds, RATE)
    except UsageError:
        return
    stays_within([path.at(tick)[0] for tick in range(path.ticks + 1)], bounds, 1 / RATE)


@settings(max_examples=25)
@given(triple, st.lists(st.tuples(triple, st.integers(1, 40)), max_size=6), bounds)
# Joint 3 needs the longest; joint 2 must not swing past its target to arrive together with it.
@example((0, 91, 96), [((0, 0, 0), 11), ((0, 0, 1.6e-140), 11), ((0, 0, 0), 1)], STEADY)
@example(
    (-63, 113, 112),
    [((0, 0, -16), 11), ((-61, 0, 0), 38), ((19, 0, 0), 39), ((22, 0, 128), 38)],
    Bounds((100,) * 3, (160,) * 3, (260,) * 3),
)
# Ruckig finds no motion from a state on the way.
@example((0, 0, 0), [((0, 0, -6), 20), ((0, 0, -78), 21), ((0, 0, 31), 17)], SUDDEN)
def test_live_targets_are_approached_within_the_bounds_and_never_passed(
    start: tuple[float, ...], targets: list[tuple[tuple[float, ...], int]], bounds: Bounds
) -> None:
    live = Live(start, evenly, bounds, RATE)
    rows, tick = [start], 0
    for target, ticks in targets:
        live.take(target, tick / RATE)
        rows += [live.step(1)[0] for _ in range(ticks)]
        tick += ticks
    while not live.done:
        rows.append(live.step(1)[0])
    assert rows[-1] == pytest.approx(live.end, abs=1e-6)
    assert live.end == pytest.approx(targets[-1][0] if targets else start, abs=1e-6)
    stays_within(rows, bounds, 1 / RATE)
    for axis, given_angles in zip(zip(*rows), zip(start, *(target for target, _ in targets))):
        assert min(given_angles) - 1e-6 <= min(axis)
        assert max(axis) <= max(given_angles) + 1e-6


def follow(path: Any, **options: Any) -> Follow:
    usual: dict[str, Any] = dict(
        speed=50, rate=None, coords=False, limits=None, silence=0.5, timeout=5.0
    )
    return Follow(TABLE, ENCODER.encode_request, 115200, path, **{**usual, **options})


def drive(
    job: Follow, late: Sequence[float] = (), reply: float = 0.001
) -> list[tuple[float, EncodedRequest]]:
    """Take the steps of a call with an arm that is always at its last target; return what it sent.

    ``late``: by how many seconds each pause is too long, in order.
    """
    now, mode, at = 100.0, 0, (0.0,) * 6
    sent: list[tuple[float, EncodedRequest]] = []
    delays = iter(late)
    steps = job.steps(now)
    step = next(steps)
    while True:
        result: Any = None
        if isinstance(step, Pause):
            now = max(now, step.until) + next(delays, 0.0)
        elif isinstance(step, Query):
            now += reply
            result = mode if step.request.command == "get_fresh_mode" else at
        elif isinstance(step, Send):
            sent.append((now, step.request))
            fields = CODEC.decode("request", step.request.frame).fields
            mode, at = fields.get("mode", mode), fields.get("angles", at)
        try:
            step = steps.send(Outcome(now, result))
        except StopIteration:
            return sent


@settings(max_examples=20)
@given(st.lists(st.sampled_from([0.0, 0.004, 0.025, 0.07, 0.3]), max_size=60))
def test_each_setpoint_is_sent_in_its_tick_and_in_order_or_counts_as_dropped(
    late: list[float],
) -> None:
    job = follow([[10, -5, 5, 0, 0, 0], [15, 0, 0, 0, 0, 5]])
    setpoints = [each for each in drive(job, late) if each[1].command.name == "send_angles"]
    path = Path((0.0,) * 6, job._waypoints, evenly, job._bounds, RATE)
    begun = setpoints[0][0] - (late[0] if late else 0) - 1 / RATE
    ticks = [math.floor((time - begun) * RATE + 1e-6) for time, _ in setpoints]
    assert all(one < other for one, other in pairwise(ticks))
    for tick, (_, request) in zip(ticks, setpoints):
        angles = CODEC.decode("request", request.frame).fields["angles"]
        assert angles == pytest.approx(path.at(tick)[0], abs=0.0051)
    report = job.report()
    assert (report.sent, report.sent + report.dropped) == (len(setpoints), path.ticks)


def test_rate_is_limited_by_the_slower_of_line_and_arm() -> None:
    # The M5's get_angles takes 12 to 15 ms at 115,200 baud, the 320's 30 ms.
    for reply, rate in ((0.001, RATE), (0.015, RATE), (0.03, BUSY_SHARE / 0.03)):
        job = follow([[30, 0, 0, 0, 0, 0]])
        drive(job, reply=reply)
        assert job.report().rate == pytest.approx(rate, rel=0.1)
        # No query is under way when a setpoint is due.
        assert job.report().dropped == 0
    with pytest.raises(UsageError, match=r"takes 0\.20 s; .* has to take 0\.16 s at most"):
        drive(follow([[30, 0, 0, 0, 0, 0]]), reply=0.2)


def test_program_that_stalls_gives_up_the_rest_of_the_path() -> None:
    job = follow([[90, 0, 0, 0, 0, 0]])
    with pytest.raises(FollowFailed, match=r"program stalled for 0\.6 s, 4 set") as caught:
        drive(job, [0, 0, 0, 0, STALL_SECONDS + 0.1])
    assert job.moving
    assert caught.value.report.ended == "stall"


def test_arm_that_stays_short_of_the_end_is_an_error() -> None:
    job = follow([[90, 0, 0, 0, 0, 0]], limits=PathLimits(acceleration=1000))
    steps = job.steps(0.0)
    step: Any = next(steps)
    now = 0.0
    error: FollowFailed | None = None
    while error is None:
        now = max(now, step.until) if isinstance(step, Pause) else now + 0.001
        fresh = isinstance(step, Query) and step.request.command == "get_fresh_mode"
        try:
            step = steps.send(Outcome(now, 1 if fresh else (1.0, 0, 0, 0, 0, 0)))
        except FollowFailed as failed:
            error = failed
    assert "stands still 89.0 degrees short of the end" in str(error)
    assert error.report.ended == "short"


@pytest.mark.parametrize(
    ("path", "options", "error"),
    [
        ([], {}, "path is []; allowed: at least one target"),
        ([[0] * 5], {}, r"path\[0\]: len\(angles\) is 5"),
        ([[0] * 6, [0, math.nan, 0, 0, 0, 0]], {}, r"path\[1\]: angles.j2 is nan"),
        ([[0, 200, 0, 0, 0, 0]], {}, r"path\[0\]: angles.j2 is 200.0; allowed"),
        (["north"], {}, r"path\[0\] is 'north'; allowed: a sequence of numbers"),
        ([Waypoint([0] * 6, 1), [0] * 6], {}, "some points of the path have times"),
        (
            [Waypoint([0] * 6, 2)] * 2,
            {},
            r"path\[1\].time is 2; allowed: seconds",
        ),
        ([[0] * 6], {"speed": 101}, "speed is 101; allowed"),
        ([[0] * 6], {"rate": 0}, "rate is 0; allowed"),
        ([[0] * 6], {"limits": PathLimits(velocity=90)}, r"limits.velocity\[0\] is 90.0; allowed"),
        ([[0] * 6], {"limits": PathLimits(jerk=[1, 2])}, "limits.jerk is .*; allowed: a number"),
    ],
)
def test_bad_argument_is_named_before_anything_is_sent(
    path: Any, options: dict[str, Any], error: str
) -> None:
    with pytest.raises(UsageError, match=error.replace("[]", r"\[\]")):
        follow(path, **options)
