"""Test that axes move together, within their speed and acceleration."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.simulator.motion import Axes
from cobotwire.simulator.motion.travel import braking, lasting, quickest

MOST = 200.0
places = st.integers(-150, 150).map(float)
points = st.tuples(places, places, places)
rates = st.integers(2, 150).map(float)
STEP = 1 / 64


def _speeds(axes: Axes, begin: float, end: float) -> list[tuple[float, ...]]:
    times = [begin + STEP * n for n in range(round((end - begin) / STEP))]
    seen = [axes.position(time) for time in times]
    return [tuple((b - a) / STEP for a, b in zip(one, two)) for one, two in pairwise(seen)]


def _holds_to(speeds: list[tuple[float, ...]], fastest: float) -> None:
    """Assert that speeds, and the differences between them, stay within their limits."""
    for one, two in pairwise(speeds):
        assert all(abs(b - a) <= MOST * STEP * 1.001 + 1e-6 for a, b in zip(one, two))
        assert all(abs(a) <= fastest * 1.001 + 1e-6 for a in one)


@given(points, rates)
def test_axes_stop_together_within_speed_and_acceleration(
    target: tuple[float, ...], rate: float
) -> None:
    axes = Axes((0.0, 0.0, 0.0), MOST)
    axes.go(target, rate, 0.0)
    way = max(map(abs, target))
    takes = way / rate + rate / MOST if way > rate * rate / MOST else 2 * (way / MOST) ** 0.5
    assert axes.moving(takes - 1e-6) == (way > 0)
    assert not axes.moving(takes + 1e-6)
    assert axes.position(takes + 1e-6) == target
    _holds_to(_speeds(_on_the_way(target, rate), 0.0, min(takes, 3.0)), rate)
    # On a straight line, each axis has moved by the same share.
    middle = _on_the_way(target, rate).position(takes / 2)
    assert middle == pytest.approx([one / 2 for one in target], abs=1e-6)


commands = st.sampled_from(["go", "queue", "brake", "pause", "resume", "forget", "look"])


@given(st.lists(st.tuples(st.floats(0.001, 1.5), commands, points, rates), max_size=12))
def test_axes_with_a_lag_follow_the_same_path_later(
    orders: list[tuple[float, str, tuple[float, ...], float]],
) -> None:
    lag, now, times = 0.125, 1.0, []
    prompt, late = Axes((0.0, 0.0, 0.0), MOST), Axes((0.0, 0.0, 0.0), MOST, lag)
    # Positions and speeds of the prompt axes, each with the time at which the late axes have them.
    expected: list[tuple[float, tuple[float, ...], tuple[float, ...]]] = []
    for wait, command, target, rate in orders:
        for _ in range(3):
            now += wait / 3
            expected.append((now + lag, prompt.position(now), prompt.speed(now)))
        times.append((now, command, target, rate))
        _order(prompt, command, target, rate, now)
    looks: list[tuple[float, Any]] = [(at, (place, speed)) for at, place, speed in expected]
    for at, what in sorted([*looks, *((at, one) for at, *one in times)], key=lambda each: each[0]):
        if isinstance(what, list):
            command, target, rate = what
            _order(late, command, target, rate, at)
        else:
            assert late.position(at) == pytest.approx(what[0], abs=1e-6)
            assert late.speed(at) == pytest.approx(what[1], abs=1e-6)
    assert not late.moving(now + 1000)


def _order(axes: Axes, command: str, target: tuple[float, ...], rate: float, now: float) -> None:
    if command in ("go", "queue"):
        axes.go(target, rate, now, queue=command == "queue")
    elif command == "look":
        axes.target(now)
    else:
        getattr(axes, command)(now)


def _on_the_way(target: tuple[float, ...], rate: float) -> Axes:
    axes = Axes((0.0, 0.0, 0.0), MOST)
    axes.go(target, rate, 0.0)
    return axes


@given(points, rates, st.lists(st.tuples(st.floats(0, 2), points, rates), max_size=4))
def test_turn_to_a_newer_target_has_no_jump_in_position_or_speed(
    target: tuple[float, ...], rate: float, turns: list[tuple[float, tuple[float, ...], float]]
) -> None:
    axes = _on_the_way(target, rate)
    now, speeds, fastest = 0.0, [], rate
    for wait, newer, new_rate in turns:
        wait = round(wait / STEP) * STEP
        speeds += _speeds(axes, now, now + wait + STEP)
        now, target, fastest = now + wait, newer, max(fastest, new_rate)
        axes.go(newer, new_rate, now)
    speeds += _speeds(axes, now, now + 2.0)
    # At a turn two samples coincide, so twice the change is allowed between neighbours.
    for one, two in pairwise(speeds):
        assert all(abs(b - a) <= 2 * MOST * STEP + 1e-6 for a, b in zip(one, two))
        assert all(abs(a) <= fastest * 1.001 + 1e-6 for a in one)
    assert axes.position(now + 1000.0) == target


@given(points, rates, st.floats(0, 3), st.floats(0, 3))
def test_pause_keeps_the_targets_and_brakes_in_the_least_time(
    target: tuple[float, ...], rate: float, first: float, pause: float
) -> None:
    axes = _on_the_way(target, rate)
    stands = axes.stop_at(first)
    axes.pause(first)
    assert axes.position(first + rate / MOST + 1e-9) == pytest.approx(stands, abs=1e-9)
    assert not axes.moving(first + rate / MOST + 1e-9)
    assert all(min(0, t) - 1e-9 <= s <= max(0, t) + 1e-9 for s, t in zip(stands, target))
    axes.resume(first + pause)
    assert axes.position(first + pause + 1000) == target


@given(st.floats(-150, 150), st.integers(-300, 300), rates, st.floats(0, 5))
def test_travel_ends_at_its_target_at_rest_after_its_duration(
    speed: float, way: int, fastest: float, more: float
) -> None:
    soon = quickest(speed, way, fastest, MOST)
    later = lasting(speed, way, MOST, soon.duration + more)
    for travel in (soon, later):
        assert travel.at(travel.duration) == pytest.approx(way, abs=1e-6)
        nearly = travel.duration * (1 - 1e-9)
        assert travel.at(nearly) == pytest.approx(way, abs=1e-3)
        assert travel.speed(nearly) == pytest.approx(0, abs=1e-3)
        assert travel.speed(0.0) == pytest.approx(speed, abs=1e-6)
    assert braking(speed, MOST).duration <= soon.duration + 1e-9


def test_bends_keep_to_the_acceleration() -> None:
    import math

    circle = [
        (60 * math.cos(turn / 50) - 60, 60 * math.sin(turn / 50), 0.0) for turn in range(1, 160)
    ]
    axes = Axes((0.0, 0.0, 0.0), MOST)
    axes.follow(circle, 150.0, 0.0)
    speeds = []
    step = 0.05  # longer than the way between two corners, so the corners approximate a bend
    seen: list[Any] = [axes.position(step * n) for n in range(200)]
    for one, two in pairwise(seen):
        speeds.append([(b - a) / step for a, b in zip(one, two)])
    for before, after in pairwise(speeds):
        assert all(abs(b - a) <= MOST * step * 1.1 for a, b in zip(before, after))
    assert seen[-1] == circle[-1]


def test_forget_drops_waiting_targets_and_continues_the_motion() -> None:
    axes = Axes((0.0,), MOST)
    axes.go((10.0,), 50.0, 0.0, queue=True)
    axes.go((20.0,), 50.0, 0.0, queue=True)
    assert axes.target(0.1) == (20.0,)
    axes.forget(0.1)
    assert axes.position(60.0) == (10.0,)
