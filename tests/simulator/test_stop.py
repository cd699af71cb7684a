"""Test what ends a motion of the simulated arm, and what the next motion does, on real ports."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm, TcpServer

# The arm's time, so that a test of some seconds of motion takes a tenth of that.
RATE = 10.0
MOVES = {
    "mycobot": [("jog_angle", 1, 1, 20), ("send_angle", 1, 40, 20), ("jog_absolute", 1, 40, 20)],
    "mycobot280": [("jog_angle", 1, 1, 20), ("send_angle", 1, 40, 20), ("jog_increment", 1, 9, 20)],
}
CASES = [(edition, move) for edition, moves in MOVES.items() for move in moves]


@pytest.fixture(params=["pty", "tcp"])
def client(request: pytest.FixtureRequest, edition: str) -> Iterator[Any]:
    package: Any = editions.load(edition)
    clock = RunningClock(RATE)
    arm = SimulatedArm(package.TABLE, clock=clock)
    server = (
        PtyServer(arm, clock) if request.param == "pty" else TcpServer(arm.connect, clock=clock)
    )
    with server, package.CLIENT(server.url) as opened:
        opened.power_on()
        yield opened


def _wait_until(client: Any, moving: bool) -> None:
    until = time.monotonic() + 10
    while bool(client.is_moving()) is not moving:
        assert time.monotonic() < until, f"is_moving stays {not moving}"
        time.sleep(0.002)


@pytest.mark.parametrize(("edition", "move"), CASES)
def test_motion_after_stop_moves_without_resume(client: Any, move: tuple[str, int]) -> None:
    name, *arguments = move
    client.jog_angle(2, 1, 20)
    _wait_until(client, True)
    client.stop()
    _wait_until(client, False)
    before = client.get_angles()
    getattr(client, name)(*arguments)
    _wait_until(client, True)
    time.sleep(0.03)
    client.stop()
    _wait_until(client, False)
    after = client.get_angles()
    assert after[0] > before[0] + 1
    assert after[1:] == before[1:]


@pytest.mark.parametrize("edition", sorted(MOVES))
def test_stop_forgets_the_motion_and_resume_does_not_continue_it(client: Any) -> None:
    client.send_angle(1, 160, 10)
    client.send_angle(2, 100, 10)
    _wait_until(client, True)
    client.stop()
    _wait_until(client, False)
    stood = client.get_angles()
    client.resume()
    time.sleep(0.05)
    assert client.get_angles() == stood
    assert stood[0] < 159


@pytest.mark.parametrize("edition", sorted(MOVES))
def test_stop_ends_a_pause_and_the_next_motion_moves(client: Any) -> None:
    client.send_angle(1, 160, 10)
    _wait_until(client, True)
    client.pause()
    _wait_until(client, False)
    assert client.is_paused()
    client.stop()
    assert not client.is_paused()
    stood = client.get_angles()
    client.send_angle(3, 40, 20)
    _wait_until(client, True)
    _wait_until(client, False)
    after = client.get_angles()
    assert after[:2] == stood[:2]
    assert after[2] == pytest.approx(40, abs=0.1)


@pytest.mark.parametrize("edition", sorted(MOVES))
def test_motion_after_pause_waits_for_resume(client: Any) -> None:
    client.pause()
    client.send_angle(1, 20, 20)
    time.sleep(0.05)
    assert (client.get_angles()[0], bool(client.is_moving())) == (0.0, False)
    client.resume()
    _wait_until(client, True)
