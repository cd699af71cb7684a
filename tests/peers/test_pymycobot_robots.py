"""A sample of ``make robots``, and the maker's unmodified classes on simulators of their robots."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire.editions import load
from pymycobot_280_requests import as_called
from pymycobot_classes import CLASSES, peer_on
from pymycobot_robot_rulings import METHODS, RULINGS
from pymycobot_robots import EDITIONS, between, compare_methods, unlisted

# Methods whose messages these editions changed, and one that they inherit.
SAMPLE = ["get_angles", "send_angle", "send_angles", "set_joint_min", "set_gripper_state"]
# Our commands that the class lacks: another name of a message that it has, or of older firmware.
WITHOUT_METHOD = {
    "MechArm270": {"jog_stop"},
    "MyCobot280RDKX5": {"jog_stop", "jog_increment", "get_radians", "send_radians"},
}


@pytest.mark.parametrize("kind", EDITIONS)
def test_requests_of_a_robot_equal_those_of_the_makers_class_or_have_a_ruling(kind: str) -> None:
    found = compare_methods(kind, SAMPLE)
    assert [each.open for each in found] == [[]] * len(SAMPLE)
    assert sum(each.equal for each in found) > 30


@pytest.mark.parametrize("kind", EDITIONS)
def test_every_command_of_a_robot_has_a_method_of_the_makers_class(kind: str) -> None:
    assert unlisted(kind) == WITHOUT_METHOD[kind]


def test_every_ruling_is_about_a_method_of_a_class_and_gives_a_reason() -> None:
    for (kind, method), ruling in RULINGS.items():
        assert hasattr(CLASSES[kind], method) or method.startswith("sync"), method
        assert ruling.why


# Without a known geometry, the simulated arm sends no coordinates. The other call always fails
# before it writes.
UNANSWERED = {
    ("MechArm270", "get_coords"),
    ("MechArm270", "angles_to_coords"),
    ("MechArm270", "solve_inv_kinematics"),
    ("MechArm270", "get_coords_plan"),
    ("MechArm270", "get_angles_coords"),
    ("MyCobot280RDKX5", "is_in_position"),
}


class ArmPort:
    """A port on a simulated arm in the same process, as pymycobot uses it."""

    def __init__(self, edition: str) -> None:
        from cobotwire.simulator import SimulatedArm

        arm = SimulatedArm(load(edition).TABLE, powered=True)
        self._peer, self._waiting = arm.connect(), b""

    def isOpen(self) -> bool:
        return True

    def reset_input_buffer(self) -> None:
        self._waiting = b""

    def write(self, data: Any) -> None:
        self._waiting += self._peer.receive(bytes(data))

    def inWaiting(self) -> int:
        return len(self._waiting)

    def read(self, size: int = 1) -> bytes:
        data, self._waiting = self._waiting[:size], self._waiting[size:]
        return data


@pytest.mark.parametrize("kind", EDITIONS)
def test_makers_class_reads_back_from_a_simulated_robot_what_it_set(kind: str) -> None:
    peer = peer_on(kind, ArmPort(EDITIONS[kind]))
    assert peer.is_power_on() == 1
    assert peer.get_angles() == [0.0] * 6
    assert peer.set_joint_max(2, 60) == 1
    assert peer.get_joint_max_angle(2) == 60.0
    assert peer.set_tool_reference([100, 20, -30, 45, 0, -90]) == 1
    assert peer.get_tool_reference() == [100, 20, -30, 45, 0, -90]
    assert peer.set_movement_type(1) == 1
    assert peer.get_movement_type() == 1
    assert peer.get_servo_temps() != -1


# It reads the language of the system in a way that Python deprecates.
@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
@pytest.mark.parametrize("kind", EDITIONS)
def test_every_method_of_the_makers_class_with_a_reply_gets_one_of_the_right_type(
    kind: str,
) -> None:
    table = load(EDITIONS[kind]).TABLE
    peer = peer_on(kind, ArmPort(EDITIONS[kind]))
    called = 0
    for command in table.commands:
        method = METHODS[kind].get(command.name, command.name)
        if not command.reply or command.ack or (kind, method) in UNANSWERED or not command.id:
            continue
        if not hasattr(peer, method) or not command.reply[0].fields:
            continue
        arguments = next(between(command.request[-1]))
        result = getattr(peer, method)(*as_called(command.name, command.request[-1], arguments))
        assert result not in (-1, None, []), method
        shown = command.reply[0].fields[-1]
        assert isinstance(result, list if shown.many else int | float), (method, result)
        called += 1
    assert called > 35
