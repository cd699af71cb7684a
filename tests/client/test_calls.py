"""Call the simulated arm with the generated client, through pyserial and a pseudo-terminal."""

from __future__ import annotations

import time

import pytest

import vectors
from cobotwire import MyCobot
from cobotwire.client import Traffic
from cobotwire.editions.mycobot import (
    Angles,
    Axis,
    Coords,
    EndType,
    FreshMode,
    ReferenceFrame,
    ServoRegister,
    TargetKind,
    WifiAccount,
)
from cobotwire.simulator import PtyServer, SimulatedArm

TOOL = Coords(1.25, -2.5, 50.0, 10.01, -0.29, 90.0)


def _wait(condition: object, seconds: float = 5.0) -> None:
    assert callable(condition)
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "the arm did not reach the target in time"
        time.sleep(0.01)


def test_calls_of_the_readme_succeed(arm: MyCobot) -> None:
    arm.power_on()
    assert arm.is_power_on() is True
    arm.send_angles([10, -20, 30.5, 0, 0.29, -5], speed=100)
    _wait(lambda: arm.is_in_position([10, -20, 30.5, 0, 0.29, -5], TargetKind.ANGLES))
    _wait(lambda: not arm.is_moving())
    # Joint positions are multiples of an encoder tick of 0.088 degrees.
    there = Angles(10.0, -20.0, 30.5, 0.0, 0.29, -5.0)
    assert arm.get_angles() == pytest.approx(there, abs=0.055)


@pytest.mark.parametrize("limit", [165.0, 10.0], ids=["target reached", "target not reached"])
def test_readme_example_runs_to_its_end(
    server: PtyServer, simulated: SimulatedArm, limit: float, capsys: pytest.CaptureFixture[str]
) -> None:
    # The arm ignores a target beyond a limit, and never reaches it.
    simulated.state.maximum[2] = limit
    text = (vectors.ROOT / "README.md").read_text()
    blocks = [part.split("```")[0] for part in text.split("```python\n")[1:]]
    [example] = [block for block in blocks if "/dev/ttyACM0" in block]
    exec(compile(example.replace("/dev/ttyACM0", server.url), "README.md", "exec"), {})
    assert "Coords(x=" in capsys.readouterr().out


def test_values_are_returned_as_named_tuples_and_enums(arm: MyCobot) -> None:
    arm.set_tool_reference(TOOL)
    assert arm.get_tool_reference() == TOOL
    assert arm.get_tool_reference().rz == 90.0
    arm.set_reference_frame(ReferenceFrame.WORLD)
    assert arm.get_reference_frame() is ReferenceFrame.WORLD
    arm.set_end_type(1)
    assert arm.get_end_type() is EndType.TOOL


def test_axis_selects_the_scale_of_a_single_coordinate(
    arm: MyCobot, simulated: SimulatedArm
) -> None:
    arm.power_on()
    arm.set_fresh_mode(FreshMode.REFRESH)
    simulated.state.angles.place((0, -30, -60, 0, 0, 0), 0.0)
    for axis, coord, field in ((Axis.X, 153.4, "x"), (Axis.RX, -92.34, "rx")):
        arm.send_coord(axis, coord, 100)
        _wait(lambda: abs(getattr(arm.get_coords(), field) - coord) < 1.0)  # noqa: B023  (awaited)


def test_replies_that_repeat_arguments_are_matched(arm: MyCobot) -> None:
    for joint in range(1, 7):
        assert arm.get_joint_min_angle(joint) == -165.0
        assert arm.is_servo_enable(joint) is False
    arm.set_digital_output(23, True)
    assert arm.get_digital_input(23) is True
    assert arm.get_digital_input(22) is False


def test_servo_registers_are_written_and_read(arm: MyCobot) -> None:
    arm.set_servo_data(2, ServoRegister.POSITION_P, 12)
    assert arm.get_servo_data(2, ServoRegister.POSITION_P) == 12
    assert arm.get_servo_data(1, ServoRegister.POSITION_P) == 10


def test_text_reply_ends_after_a_silence(arm: MyCobot, simulated: SimulatedArm) -> None:
    assert arm.get_ssid_pwd() == WifiAccount("MyCobotWiFi2.4G", "mycobot123")
    simulated.state.ssid, simulated.state.password = "two words", "pass word "
    assert arm.get_ssid_pwd() == WifiAccount("two words", "pass word ")
    assert arm.is_power_on() is False, "the next call succeeds"


def test_every_request_is_sent_exactly_once(server: PtyServer) -> None:
    traffic: list[Traffic] = []
    with MyCobot(server.url, trace=traffic.append) as arm:
        arm.power_on()
        arm.jog_increment(1, 5.0, 50)
        arm.get_angles()
    sent = [t.data.hex(" ") for t in traffic if t.direction == "sent"]
    assert sent == ["fe fe 02 10 fa", "fe fe 06 33 01 01 f4 32 fa", "fe fe 02 20 fa"]


@pytest.mark.parametrize("codec", ["reference", "native"])
def test_client_uses_the_codec_it_is_given(server: PtyServer, codec: str) -> None:
    with MyCobot(server.url, codec="native" if codec == "native" else "reference") as arm:
        assert arm.codec == codec
        assert arm.get_angles() == Angles(0, 0, 0, 0, 0, 0)
        assert codec in repr(arm)
