"""The simulated arm in the edition of today's 280."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.sim import PtyServer, SimulatedArm

REFERENCE = codecs.load(TABLE, "reference")
REQUESTS = strategies.messages(TABLE).filter(lambda message: message[0].direction == "request")


class Bench:
    """An arm, its clock, and the questions of a test."""

    def __init__(self, *, acks: bool = True) -> None:
        self.now = 0.0
        self.arm = SimulatedArm(TABLE, clock=lambda: self.now, acks=acks)

    def tell(self, name: str, *values: Any) -> bytes:
        return self.arm.receive(REFERENCE.encode(name, "request", values))

    def ask(self, name: str, *values: Any) -> Any:
        message = REFERENCE.decode("reply", self.tell(name, *values), of=name)
        found = [v for f, v in zip(message.layout.fields, message.values) if not f.echo]
        return found[0] if len(found) == 1 else tuple(found)


@pytest.fixture
def bench() -> Bench:
    made = Bench()
    made.tell("power_on")
    return made


@given(st.lists(REQUESTS, max_size=8))
def test_every_legal_request_gets_its_legal_answer_and_no_other(
    requests: list[tuple[strategies.Form, Any]],
) -> None:
    bench = Bench()
    for form, values in requests:
        bench.now += 0.1
        answer = bench.tell(form.command.name, *values)
        if form.command.text is not None:
            assert answer.startswith(b"ssid: ")
        elif form.command.reply:
            assert REFERENCE.decode("reply", answer).command.id == form.command.id
        else:
            assert answer == b""


def test_setters_are_acknowledged_unless_the_arm_is_told_not_to(bench: Bench) -> None:
    assert bench.tell("set_color", 1, 2, 3) == bytes.fromhex("FE FE 03 6A 01 FA")
    silent = Bench(acks=False)
    assert silent.tell("set_color", 1, 2, 3) == b""
    assert silent.ask("is_power_on") == 0


def test_limits_are_those_of_the_edition(bench: Bench) -> None:
    assert bench.ask("get_joint_max_angle", 1) == 168.0
    assert bench.ask("get_joint_min_angle", 2) == -140.0


def test_what_was_set_is_read_back(bench: Bench) -> None:
    for setter, getter, value in (
        ("set_fresh_mode", "get_fresh_mode", 1),
        ("set_movement_type", "get_movement_type", 1),
        ("set_transponder_mode", "get_transponder_mode", 1),
        ("set_HTS_gripper_torque", "get_HTS_gripper_torque", 500),
        ("set_gripper_protect_current", "get_gripper_protect_current", 250),
    ):
        bench.tell(setter, value)
        assert bench.ask(getter) == value


def test_steps_and_plans(bench: Bench) -> None:
    bench.tell("send_angles", (0, -30.0, -60.0, 0, 0, 0), 50)
    bench.now += 5.0
    height = bench.ask("get_coords")[2]
    bench.tell("jog_increment_coord", 3, 12.5, 50)
    planned = bench.ask("get_coords_plan")[2]
    bench.now += 5.0
    assert bench.ask("get_coords")[2] == planned == pytest.approx(height + 12.5, abs=0.8)
    bench.tell("send_angle", 1, 10.0, 50)
    assert bench.ask("get_angles_plan")[0] == 10.01, "the tick's angle, cut to hundredths"
    bench.now += 5.0
    angles, coords = bench.ask("get_angles_coords")
    assert (angles[0], coords[2]) == (10.01, planned)


def test_servo_registers_are_backed_up_and_restored(bench: Bench) -> None:
    bench.tell("backup_servo_params", 254)
    bench.tell("set_servo_data", 1, 21, 99)
    assert bench.ask("get_servo_data", 1, 21) == 99
    bench.tell("restore_servo_params", 1)
    assert bench.ask("get_servo_data", 1, 21) == 10
    bench.tell("set_servo_data", 1, 30, 1000, 1)
    assert bench.ask("get_servo_data", 1, 30, 1) == 1000
    assert bench.ask("get_servo_data", 1, 30) == 1000 % 256


def test_a_recording_is_played_point_by_point(bench: Bench) -> None:
    assert bench.ask("drag_start_record") == 1
    assert bench.ask("drag_end_record") == 2
    assert bench.ask("drag_get_record_len") == 2
    assert bench.ask("drag_get_record_data")[::2] == (2048,) * 6
    bench.tell("drag_get_record_data")
    assert bench.ask("drag_get_record_data") == (0,) * 12, "zeros behind the last point"
    assert bench.ask("drag_clear_record_data") == 0


def test_all_servos_are_held_at_once(bench: Bench) -> None:
    bench.tell("release_all_servos")
    assert bench.ask("is_all_servo_enable") in (0, (0, (0,) * 5))
    bench.tell("focus_all_servos", 0)
    assert bench.ask("is_servo_enable", 6) == 1


def test_the_account_comes_as_text_behind_the_frame() -> None:
    arm = SimulatedArm(TABLE)
    with PtyServer(arm) as server, MyCobot280(server.url) as client:
        client.set_ssid_pwd("home", "se cret")
        assert client.get_ssid_pwd().password == "se cret"
        assert arm.state.ssid == "home"
        client.set_color(1, 2, 3)
        client.send_radians([0.1] * 6, speed=50)
        assert client.is_power_on() is False, "acknowledgements are no answers"
