"""What the servos of the simulated arm tell, and what a restart leaves of it."""

from __future__ import annotations

import random
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from kinematic_samples import random_angles

REFERENCE = codecs.load(TABLE, "reference")
STEPS_A_DEGREE = 4096 / 360


class Bench:
    """An arm that is powered, and whose clock the test steps."""

    def __init__(self) -> None:
        self.clock = SteppedClock()
        self.arm = SimulatedArm(TABLE, clock=self.clock)
        self.tell("power_on")

    def tell(self, name: str, *values: Any) -> bytes:
        return self.arm.receive(REFERENCE.encode(name, "request", values))

    def ask(self, name: str, *values: Any) -> Any:
        return REFERENCE.decode("reply", self.tell(name, *values), of=name).values[-1]


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_servos_tell_how_fast_they_turn_the_way_their_encoders_count(bench: Bench) -> None:
    assert bench.ask("get_servo_speeds") == (0,) * 6
    bench.tell("send_angles", (90.0, 0.0, 90.0, 0.0, 45.0, 0.0), 40)
    bench.clock.sleep(0.8)
    cruise = round(60 * STEPS_A_DEGREE)
    assert bench.ask("get_servo_speeds") == (-cruise, 0, cruise, 0, -round(30 * STEPS_A_DEGREE), 0)
    before = bench.ask("get_encoders")
    bench.clock.sleep(0.1)
    gone = [b - a for a, b in zip(before, bench.ask("get_encoders"))]
    assert gone == pytest.approx([v / 10 for v in bench.ask("get_servo_speeds")], abs=1)
    bench.clock.sleep(10)
    assert bench.ask("get_servo_speeds") == (0,) * 6


def test_a_braking_arm_tells_how_fast_it_still_is(bench: Bench) -> None:
    bench.tell("send_angle", 3, 100.0, 40)
    bench.clock.sleep(1.0)
    bench.tell("stop")
    bench.clock.sleep(0.1)
    assert bench.ask("get_servo_speeds")[2] == round((60 - 0.1 * 200) * STEPS_A_DEGREE)


def test_the_grippers_encoder_is_set_and_read_back(bench: Bench) -> None:
    bench.tell("set_encoder", 7, 2048 + 70, 50)
    bench.clock.sleep(5)
    assert (bench.ask("get_encoder", 7), bench.ask("get_gripper_value")) == (2118, 70)
    bench.tell("set_encoder", 7, 1000, 50)
    assert "2048 to 2148" in bench.arm.notes[-1].text
    bench.clock.sleep(5)
    assert bench.ask("get_gripper_value") == 70


def test_what_get_angles_tells_is_calculated_to_what_get_coords_tells(bench: Bench) -> None:
    rng = random.Random(6)
    for _ in range(50):
        bench.arm.state.angles.place(random_angles(rng), bench.clock())
        calculated = bench.ask("angles_to_coords", bench.ask("get_angles"))
        assert calculated == bench.ask("get_coords")


def test_an_order_to_a_paused_arm_waits_and_the_notes_say_so(bench: Bench) -> None:
    bench.tell("pause")
    for order in (("send_angle", 1, 30.0, 50), ("jog_angle", 2, 1, 50), ("jog_coord", 3, 0, 50)):
        before = len(bench.arm.notes)
        bench.tell(*order)
        [note] = bench.arm.notes[before:]
        assert (note.command, "waits" in note.text) == (order[0], True)
    bench.tell("resume")
    bench.tell("send_angle", 1, 30.0, 50)
    assert len(bench.arm.notes) == 3


def test_motions_are_acknowledged_when_they_are_heard(bench: Bench) -> None:
    assert bench.tell("send_angle", 1, 30.0, 1) == bytes.fromhex("FE FE 03 21 01 FA")
    assert bench.ask("is_moving") == 1
    assert bench.ask("check_async_or_sync") == 0, "so it works asynchronously"


def test_a_restart_loses_what_was_set_but_moves_no_joint(bench: Bench) -> None:
    assert bench.ask("get_reboot_count") == 1
    bench.tell("send_angles", (90.0, -45.0, 22.5, 0.0, 45.0, -90.0), 60)
    bench.tell("set_gripper_value", 40, 50)
    bench.clock.sleep(0.9)
    bench.tell("set_fresh_mode", 1)
    stood = bench.ask("get_angles"), bench.ask("get_gripper_value")
    other = bench.arm.another_line()
    other.restart()
    bench.clock.sleep(1)
    assert (bench.ask("get_angles"), bench.ask("get_gripper_value")) == stood
    assert stood[0][0] > 10
    assert (bench.ask("is_power_on"), bench.ask("get_fresh_mode")) == (0, 0)
    assert bench.ask("get_joint_max_angle", 1) == 168.0, "the edition's limits come back"
    assert bench.ask("get_reboot_count") == 2
