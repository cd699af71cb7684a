"""The classes of the Pro robots: grippers at the tool's serial line, and pins."""

from __future__ import annotations

import sys
from typing import Any

import pytest

from cobotwire.editions.pro450 import messages
from cobotwire.protocol.errors import (
    ArmNotReady,
    ProtocolError,
    RequestRefused,
    UsageError,
)
from cobotwire.pymycobot.layer.modbus_gripper import check_of
from cobotwire.simulator.behaviour import Behaviours, Sized
from cobotwire.simulator.behaviour.registry import Unanswerable
from layer.arms import Replies, made
from recorded_pins import installed_pins


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
def test_gripper_is_searched_for_at_two_speeds(baud: int, modbus: bool, found: bool) -> None:
    gripper = Gripper(baud, modbus)
    arm, _ = made("Pro450Client", behaviours=gripper.behaviours())
    assert arm.set_pro_gripper_init() is found
    assert gripper.modbus is (modbus or found)
    assert gripper.baud == (115200 if found else 9600)


def test_pro_450_jogs_only_if_targets_are_queued() -> None:
    arm, _ = made("Pro450Client")
    assert arm.jog_angle(1, 1, 10) == 1
    arm.set_fresh_mode(1)
    with pytest.raises(ArmNotReady, match="call set_fresh_mode"):
        arm.jog_angle(1, 1, 10)


def test_pro_630_switches_its_power_by_a_pin(monkeypatch: pytest.MonkeyPatch) -> None:
    pins = installed_pins(monkeypatch)
    arm, robot = made("Pro630", powered=False)
    assert arm.power_on(delay=0) == 1
    assert robot.state.powered
    assert ("output", (4, 1)) in pins.called
    assert arm.get_basic_input(1) == 1
    assert pins.called[-2:] == [("setup", (17, "in")), ("input", (17,))]
    assert arm.power_off() == 1
    assert pins.called[-1] == ("output", (4, 0))


def test_pro_630_names_the_package_that_pins_need(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "RPi.GPIO", None)
    arm, _ = made("Pro630")
    with pytest.raises(UsageError, match=r"RPi\.GPIO.*Pro630Client"):
        arm.power_on_only()
