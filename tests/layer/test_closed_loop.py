"""The classes of the Mercury and the Pro robots: motions that the arm reports back."""

from __future__ import annotations

import sys
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest

import cobotwire.pymycobot as layer
from cobotwire.editions import load, mercury_a1, mercury_b1, pro450
from cobotwire.editions.pro450 import messages
from cobotwire.protocol.errors import (
    ArmNotReady,
    ProtocolError,
    ReplyTimeout,
    RequestRefused,
    UsageError,
)
from cobotwire.pymycobot.layer.modbus_gripper import check_of
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm
from cobotwire.simulator.behaviour import Behaviours, Sized
from cobotwire.simulator.behaviour.registry import Unanswerable
from cobotwire.simulator.clock import SteppedClock

HOME = [0, 0, 0, 0, 0, 90, 0]
# The id of a request; the first bytes and the size of the frame that reports the end of a motion.
SEND_ANGLES, END, END_SIZE = 0x22, bytes([0xFE, 0xFE, 4, 0x5B]), 7


class Deaf:
    """A robot that never reports the end of a motion."""

    def __init__(self, arm: SimulatedArm) -> None:
        self._arm = arm.connect()

    @property
    def wait(self) -> float | None:
        return self._arm.wait

    def receive(self, data: bytes) -> bytes:
        return self._without_ends(self._arm.receive(data))

    def flush(self) -> bytes:
        return self._without_ends(self._arm.flush())

    def _without_ends(self, data: bytes) -> bytes:
        before, found, after = data.partition(END)
        return before + after[END_SIZE - len(END) :] if found else data


class Early(Deaf):
    """A robot that reports the end of an earlier motion after it has accepted the next one."""

    def receive(self, data: bytes) -> bytes:
        reply = super().receive(data)
        early = _codec("mercury_a1").encode("motion_ended", "reply", (0,))
        return reply + early if data[3] == SEND_ANGLES else reply

    def _without_ends(self, data: bytes) -> bytes:
        return data


class Replies:
    """A tool at the end of the arm that sends these bytes."""

    wait = None

    def __init__(self, edition: str, *replies: bytes) -> None:
        self._codec = _codec(edition)
        self._replies = list(replies)

    def receive(self, data: bytes) -> bytes:
        reply = self._replies.pop(0)
        variant = len(reply) - 1
        frame: bytes = self._codec.encode(
            "tool_serial_write_data", "reply", (reply,), variant=variant
        )
        return frame

    def flush(self) -> bytes:
        return b""


def _codec(edition: str) -> Any:
    from cobotwire import codec

    return codec.load(load(edition).TABLE)


def made(
    name: str, edition: str = "", errors: Any = "raise", powered: bool = True, peer: Any = None
) -> tuple[Any, Any]:
    """Return an arm of a class on a simulated robot in stepped time, and that robot."""
    kind = getattr(layer, name)
    native = load(edition).CLIENT if edition else kind.NATIVE
    clock = SteppedClock()
    arm = SimulatedArm(native.table, clock=clock, powered=powered)
    found = object.__new__(kind)
    given = arm.connect() if peer is None else peer(arm)
    found._open(partial(native, MemoryTransport(given, clock)), False, errors)
    found.clock, found._waits = clock, True
    return found, arm


@pytest.mark.parametrize(
    ("name", "edition", "target"),
    [
        ("Mercury", "mercury_a1", HOME),
        ("MercurySocket", "", HOME),
        ("Pro400", "", [10] * 6),
        ("Pro630Client", "", [10] * 6),
        ("Pro450Client", "", [10] * 6),
    ],
)
def test_motion_returns_when_the_arm_is_there(name: str, edition: str, target: list[float]) -> None:
    arm, _ = made(name, edition)
    before = arm.clock()
    assert arm.send_angles(target, 20) in (0, 1)
    assert arm.get_angles() == pytest.approx(target, abs=0.1)
    assert arm.clock() - before > 0.1
    before = arm.clock()
    assert arm.send_angles([0] * len(target), 20, _async=True) == 1
    assert arm.clock() - before < 0.1


def test_motion_after_one_that_was_not_waited_for_waits_for_its_own_end() -> None:
    arm, _ = made("Mercury", "mercury_a1", peer=Early)
    arm.send_angle(1, 10, 50, _async=True)
    assert arm.send_angles([40, 0, 0, 0, 0, 0, 0], 5) == 0
    assert arm.get_angle(1) == pytest.approx(40, abs=0.1)


def test_failed_motion_raises_or_returns_its_status() -> None:
    arm, _ = made("Mercury", "mercury_a1", powered=False)
    with pytest.raises(RequestRefused, match=r"send_angles\(\): status is "):
        arm.send_angles(HOME, 50)
    arm, _ = made("Mercury", "mercury_a1", errors="return", powered=False)
    assert arm.send_angles(HOME, 50) > 1


def test_end_that_is_lost_is_noticed() -> None:
    arm, _ = made("Mercury", "mercury_a1", peer=Deaf)
    with pytest.raises(ReplyTimeout, match=r"send_angles\(\) at the end of its motion"):
        arm.send_angles(HOME, 50)
    arm, _ = made("Mercury", "mercury_a1", errors="return", peer=Deaf)
    assert arm.send_angles(HOME, 50) == -1
    assert arm.get_angles() == pytest.approx(HOME, abs=0.1)


def test_motions_do_not_wait_if_their_ends_are_not_reported() -> None:
    arm, _ = made("Mercury", "mercury_a1")
    assert arm.set_limit_switch(2, 0) == 1
    before = arm.clock()
    assert arm.send_angles(HOME, 5) == 1
    assert arm.clock() - before < 0.1
    arm.open()
    assert arm.send_angles(HOME, 5) == 1


def test_simulated_arm_reports_ends_only_while_that_is_on() -> None:
    arm, _ = made("Mercury", "mercury_a1")
    assert arm.get_limit_switch() == [1, 1]
    arm.set_limit_switch(2, 0)
    with arm.arm.events(mercury_a1.MotionEnded, timeout=5) as ends:
        arm.send_angles(HOME, 50)
        assert list(ends) == []
        arm.set_limit_switch(2, 1)
        arm.send_angle(1, 10, 50, _async=True)
        assert next(ends).status == 0


@pytest.mark.parametrize(
    ("method", "arguments", "why"),
    [
        ("set_limit_switch", (2, 1), "the arm has no power; call power_on()"),
        ("drag_teach_execute", (), "no points are recorded"),
    ],
)
def test_order_that_cannot_work_says_why(method: str, arguments: tuple[Any, ...], why: str) -> None:
    arm, _ = made("Mercury", "mercury_a1", powered=False)
    with pytest.raises(ArmNotReady) as raised:
        getattr(arm, method)(*arguments)
    assert why in str(raised.value)
    arm, _ = made("Mercury", "mercury_a1", errors="return", powered=False)
    assert getattr(arm, method)(*arguments) == -1


def test_arm_that_is_silent_can_be_opened() -> None:
    class Silent(Deaf):
        def _without_ends(self, data: bytes) -> bytes:
            return b""

    arm, _ = made("Mercury", "mercury_a1", errors="return", peer=Silent)
    assert arm.get_angles() == -1


def test_name_of_the_port_says_which_robot_it_is() -> None:
    with PtyServer(SimulatedArm(mercury_b1.TABLE)) as server:

        class OnBody(layer.Mercury):
            PORTS = (server.url, "/dev/right_arm")

        arm = OnBody(server.url)
        assert isinstance(arm.arm, mercury_b1.MercuryB1)
        assert arm.get_servo_cw(11) == 0
        arm.close()
    with PtyServer(SimulatedArm(mercury_a1.TABLE)) as server:
        alone = layer.Mercury(server.url)
        assert isinstance(alone.arm, mercury_a1.MercuryA1)
        for call in (alone.get_base_coords, partial(alone.is_in_position, [0] * 6, 2)):
            with pytest.raises(
                UsageError, match="needs an arm on a body: its port is /dev/left_arm"
            ):
                call()
        alone.close()


@pytest.mark.parametrize(
    ("name", "method", "arguments", "text"),
    [
        ("Mercury", "set_pro_gripper_angle", (300,), "gripper_angle is 300"),
        ("Mercury", "set_hand_gripper_p", (9, 5), "hand_id is 9"),
        ("Mercury", "set_hand_gripper_pinch_action_speed_consort", (7, 0), "pinch_pose is 7"),
        ("Mercury", "is_in_position", ([0] * 5,), "len(data) is 5"),
        ("Mercury", "is_in_position", ([0] * 7, 3), "mode is 3"),
        ("Mercury", "get_coords", ([0] * 5,), "len(angles) is 5"),
        ("Pro450Client", "set_pro_gripper_angle", (101,), "gripper_angle is 101"),
        ("Pro450Client", "get_pro_gripper_angle", (0,), "gripper_id is 0"),
        ("Pro450Client", "base_external_can_control", (0, [1]), "can_id is 0"),
        ("Pro450Client", "set_limit_switch", (3, 1), "limit_mode is 3"),
        ("Pro630", "set_basic_output", (7, 1), "pin_no is 7"),
    ],
)
def test_wrong_argument_is_named_as_in_the_library(
    name: str, method: str, arguments: tuple[Any, ...], text: str
) -> None:
    arm, _ = made(name)
    with pytest.raises(UsageError) as raised:
        getattr(arm, method)(*arguments)
    assert str(raised.value).startswith(f"{text}; allowed: ")


def _frame(*data: int) -> bytes:
    return bytes(data) + check_of(bytes(data)).to_bytes(2, "little")


@pytest.mark.parametrize(
    ("reply", "error", "text"),
    [
        (_frame(14, 6, 0, 11, 0, 0), RequestRefused, "write of register 11: status is 0"),
        (_frame(14, 6, 0, 10, 0, 1), ProtocolError, "another request than that for register 11"),
        (b"\x0e", ProtocolError, "another request than that for register 11"),
    ],
)
def test_gripper_that_does_not_accept_a_value_raises_or_returns_minus_one(
    reply: bytes, error: type[Exception], text: str
) -> None:
    arm, _ = made("Pro450Client", peer=lambda arm: Replies("pro450", reply))
    with pytest.raises(error, match=text):
        arm.set_pro_gripper_angle(50)
    arm, _ = made("Pro450Client", errors="return", peer=lambda arm: Replies("pro450", reply))
    assert arm.set_pro_gripper_angle(50) == -1


def test_gripper_of_the_pro_450_is_read_and_written() -> None:
    replies = _frame(14, 6, 0, 11, 0, 1), _frame(14, 3, 0, 12, 0, 50), _frame(14, 3, 0, 1, 0, 12)
    arm, _ = made("Pro450Client", peer=lambda arm: Replies("pro450", *replies))
    assert arm.set_pro_gripper_open() == 1
    assert arm.get_pro_gripper_angle() == 50
    assert arm.get_pro_gripper_firmware_version() == 1.2


class Gripper:
    """A gripper of a Pro 450 at the simulated arm: it replies only at its speed and in its mode."""

    def __init__(self, baud: int, modbus: bool) -> None:
        self.baud, self.modbus, self.bus = baud, modbus, 115200

    def behaviours(self) -> Any:
        found = Behaviours()
        found.behaviour(messages.serial.ToolSerialWriteData)(self.reply)
        found.behaviour(messages.serial.SetToolSerialBaudRate)(self.set_speed)
        return found

    def set_speed(self, arm: Any, now: float, request: Any) -> None:
        self.bus = request.baud

    def reply(self, arm: Any, now: float, request: Any) -> Any:
        data = bytes(request.data)
        own = data[:2] == b"\xfe\xfe"
        if self.bus != self.baud or own == self.modbus:
            raise Unanswerable("the gripper does not understand it")
        at = 3 if own else 0
        if data[at + 3] == 47:
            self.modbus = True
        elif data[at + 3] == 5:
            self.baud = 115200
        reply = data[: at + 4] + b"\0\x01" + b"\0\0"
        return Sized(messages.serial.ToolSerialWriteDataReply(reply), len(reply))


@pytest.mark.parametrize(
    ("baud", "modbus", "found"),
    [
        (115200, True, True),
        (115200, False, True),
        (1000000, True, True),
        (1000000, False, True),
        (9600, True, False),
    ],
)
def test_gripper_is_searched_at_two_speeds(baud: int, modbus: bool, found: bool) -> None:
    gripper = Gripper(baud, modbus)
    clock = SteppedClock()
    robot = SimulatedArm(pro450.TABLE, clock=clock, powered=True, behaviours=gripper.behaviours())
    arm = object.__new__(layer.Pro450Client)
    arm._open(partial(pro450.CLIENT, MemoryTransport(robot, clock)), False, "raise")
    assert arm.set_pro_gripper_init() is found
    assert gripper.modbus is (modbus or found)
    assert gripper.baud == (115200 if found else 9600)


def test_pro_450_jogs_only_if_targets_are_queued() -> None:
    arm, _ = made("Pro450Client")
    assert arm.jog_angle(1, 1, 10) == 1
    arm.set_fresh_mode(1)
    with pytest.raises(ArmNotReady, match="call set_fresh_mode"):
        arm.jog_angle(1, 1, 10)


class Pins:
    """Notes what is done with the pins of the computer inside of a Pro 630."""

    BCM, IN, OUT, LOW, HIGH = "BCM", "in", "out", 0, 1

    def __init__(self) -> None:
        self.done: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        def noted(*arguments: Any) -> int:
            self.done.append((name, *arguments))
            return 1

        return noted


def test_pro_630_switches_its_power_by_a_pin(monkeypatch: pytest.MonkeyPatch) -> None:
    pins = Pins()
    monkeypatch.setitem(sys.modules, "RPi", SimpleNamespace(GPIO=pins))
    monkeypatch.setitem(sys.modules, "RPi.GPIO", pins)
    arm, robot = made("Pro630", powered=False)
    assert arm.power_on(delay=0) == 1
    assert robot.state.powered
    assert ("output", 4, 1) in pins.done
    assert arm.get_basic_input(1) == 1
    assert pins.done[-2:] == [("setup", 17, "in"), ("input", 17)]
    assert arm.power_off() == 1
    assert pins.done[-1] == ("output", 4, 0)


def test_pro_630_names_the_package_that_pins_need(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "RPi.GPIO", None)
    arm, _ = made("Pro630")
    with pytest.raises(UsageError, match=r"RPi\.GPIO.*Pro630Client"):
        arm.power_on_only()
