"""Test the arm that somebody leads by hand while its servos are released, on real ports."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from cobotwire import UsageError
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm, TcpServer
from cobotwire.simulator.motion.hand import read_points
from simulator.bench import Bench

RATE = 10.0
POINTS = [(1.0, (20.0, 0, 0, 0, 0, 0)), (3.0, (20.0, -30.0, 10.0, 0, 0, 40.0))]
LAST = pytest.approx(POINTS[-1][1], abs=0.1)


@pytest.fixture(params=["pty", "tcp"])
def client(request: pytest.FixtureRequest) -> Iterator[MyCobot280]:
    clock = RunningClock(RATE)
    arm = SimulatedArm(TABLE, clock=clock, powered=True)
    arm.lead(POINTS)
    pty = request.param == "pty"
    server = PtyServer(arm, clock) if pty else TcpServer(arm.connect, clock=clock)
    with server, MyCobot280(server.url) as opened:
        yield opened


def test_teach_in_of_a_released_arm_reads_a_path_and_replays_it(client: MyCobot280) -> None:
    assert tuple(client.get_angles()) == (0.0,) * 6, "a held arm is not led"
    client.release_all_servos()
    path, until = [], time.monotonic() + 0.4
    while time.monotonic() < until:
        path.append(tuple(client.get_angles()))
        time.sleep(0.02)
    assert not client.is_moving(), "the arm does not move by itself"
    assert len(set(path)) > 5
    assert path[-1] == LAST
    client.power_on()
    client.move_angles(path[0], 100)
    client.move_angles(path[-1], 100)
    assert tuple(client.get_angles()) == pytest.approx(path[-1], abs=0.1)


def test_recording_by_hand_holds_the_path(client: MyCobot280) -> None:
    client.release_all_servos()
    client.drag_start_record()
    time.sleep(0.4)
    points = client.drag_end_record()
    assert points > 20
    read = [tuple(client.drag_get_record_data()) for _ in range(points)]
    assert len(set(read)) > 15


def test_hand_stops_when_the_arm_is_held_and_begins_again_when_it_is_released() -> None:
    bench = Bench(TABLE)
    bench.arm.lead(POINTS)
    bench.send("release_all_servos")
    bench.clock.sleep(0.5)
    for command in ("stop", "pause", "resume"):
        bench.send(command)
    assert bench.query("get_angles")[0] == pytest.approx(10.0, abs=0.1)
    bench.send("power_on")
    bench.clock.sleep(5)
    assert bench.query("get_angles")[0] == pytest.approx(10.0, abs=0.1)
    bench.send("set_free_mode", True)
    bench.clock.sleep(2.0)
    assert bench.query("get_angles")[1] == pytest.approx(-15.0, abs=0.1)
    bench.send("set_free_mode", False)
    bench.send("send_angle", 1, 0.0, 100)
    assert bench.query("is_moving") == 1
    bench.clock.sleep(5)
    assert bench.query("get_angles")[0] == 0.0


def test_file_with_points_is_read_and_its_mistakes_are_reported(tmp_path: Path) -> None:
    path = tmp_path / "hand.txt"
    path.write_text("# seconds, angles\n1 20 0 0 0 0 0\n\n3, 20, -30, 10, 0, 0, 40  # up\n")
    assert list(read_points(path, 6)) == POINTS
    for text, mistake in [
        ("1 2 3\n", "hand.txt:1: .*6 angles"),
        ("1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n", "hand.txt:2: seconds is 1"),
        ("1 0 0 0 0 0 up\n", "hand.txt:1: expected seconds and 6 angles"),
        ("nan 0 0 0 0 0 0\n", "hand.txt:1: seconds"),
        ("# nothing\n", "no point"),
    ]:
        path.write_text(text)
        with pytest.raises(UsageError, match=mistake):
            read_points(path, 6)
    with pytest.raises(UsageError, match="No such file"):
        read_points(tmp_path / "none.txt", 6)
