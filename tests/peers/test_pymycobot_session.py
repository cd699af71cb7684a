"""pymycobot, unmodified, runs a whole session over a pty and over TCP, with its own waiting.

The session comes from bench/pymycobot_session.py.
"""

from __future__ import annotations

from typing import Any

import pytest

from pymycobot_session import POSE, SERVERS, SESSION, Called, play, session

DONE = 1
ARM_SPEED = 4.0


@pytest.fixture(scope="module", params=list(SERVERS))
def called(request: pytest.FixtureRequest) -> list[Called]:
    """Run one session on each kind of transport, in accelerated time."""
    with session("pymycobot", request.param, ARM_SPEED) as (client, clock):
        return play(client, clock)


def results(called: list[Called], name: str) -> list[Any]:
    return [one.result for step, one in zip(SESSION, called) if step.name == name]


def test_every_setter_is_acknowledged_before_pymycobot_repeats_it(called: list[Called]) -> None:
    for step, one in zip(SESSION, called):
        if step.name.startswith(("set_", "send_", "sync_", "jog_", "power_", "stop", "resume")):
            assert one.result == DONE, step
        # pymycobot waits 0.3 s (TCP) or 0.5 s if no reply comes.
        assert step.name.startswith("sync_") or one.seconds < 0.28, step


def test_power_and_motion_read_back_as_they_were_set(called: list[Called]) -> None:
    assert results(called, "is_power_on") == [0, 1, 0]
    assert results(called, "is_moving") == [1, 0]


def test_synchronous_motion_ends_on_arrival_and_not_by_timeout(called: list[Called]) -> None:
    waited = [one.seconds for step, one in zip(SESSION, called) if step.name.startswith("sync_")]
    assert max(waited) < 10, "15 s is its timeout"
    there, back, jogged = results(called, "get_angles")
    assert there == pytest.approx(POSE, abs=0.1)
    assert jogged[1] != back[1]


def test_coordinates_read_back_as_they_were_sent(called: list[Called]) -> None:
    read, again = results(called, "get_coords")
    assert again == pytest.approx(read, abs=0.5)


def test_gripper_and_pins_read_back_as_they_were_set(called: list[Called]) -> None:
    assert results(called, "get_gripper_value") == [60]
    assert results(called, "get_digital_input") == [1]
    assert results(called, "get_basic_input") == [1]


def test_our_client_runs_the_same_session_without_an_error() -> None:
    with session("cobotwire", "TCP", ARM_SPEED) as (client, clock):
        called = play(client, clock)
    assert not [one.result for one in called if isinstance(one.result, Exception)]
