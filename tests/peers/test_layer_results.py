"""Replies and registers that both classes read: results are equal, or a ruling says why not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from cobotwire.pymycobot.layer.registers import OF_A_JOINT
from layer_comparison import FAILED, REJECTED, Called, call_ours, call_theirs
from layer_robots import ALL_ROBOTS
from migrated_calls import kinds
from robots.robot import Call, Robot

# pymycobot reads the locale in a way that Python deprecates.
pytestmark = pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
MERCURY = ("Mercury (A1)", "Mercury (B1, X1)", "MercurySocket")
POWER = (*MERCURY, "Pro400", "Pro400Client", "Pro630", "Pro630Client", "Pro450Client")


def words(*numbers: int) -> bytes:
    """Return numbers as words with their high bytes first."""
    return b"".join((number & 0xFFFF).to_bytes(2, "big") for number in numbers)


def tool(*numbers: int) -> bytes:
    """Return the data of a reply of a gripper: its number, and words."""
    return b"\x0e" + words(*numbers)


def frame(robot: Robot, command: int, data: bytes, address: int) -> bytes:
    """Return a frame of a robot with any data, also with data that no edition allows."""
    given = address if robot.table.addresses else None
    return robot.table.frame.enclose(command, data, given, "reply")


def both(name: str, method: str, given: Sequence[Any], reply: bytes | None) -> list[Called]:
    """Return what the maker's method and ours wrote and returned."""
    robot = ALL_ROBOTS[name]
    call = Call(method, tuple(given), method, tuple(given), None)
    return [call_theirs(robot, call, reply), call_ours(robot, call, reply)]


def replied(name: str, method: str, given: Sequence[Any], command: int, data: bytes) -> list[Any]:
    """Return the results of both for a reply."""
    robot = ALL_ROBOTS[name]
    address = given[0] if given and isinstance(given[0], int) else 0
    reply = frame(robot, command, data, address)
    return [each.result for each in both(name, method, given, reply)]


_WORDS = words(1234, -567, 89, 4500, -9000, 17999)
_PLACE = [1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize(
    ("name", "method", "given", "command", "data"),
    [
        # Replies that the simulated robot never sends, for each limb and for lengths and angles.
        ("MyBuddy", "get_coord", (1, 1), 0x2D, words(1234)),
        ("MyBuddy", "get_coord", (2, 3), 0x2D, words(-1234)),
        ("MyBuddy", "get_coord", (1, 4), 0x2D, words(4567)),
        ("MyBuddy", "get_coord", (3, 1), 0x2D, words(4567)),
        ("MyBuddy", "get_coords", (1,), 0x23, _WORDS),
        ("MyBuddy", "get_base_coord", (2,), 0xF3, _WORDS),
        ("MyBuddy", "get_base_coords", (), 0xF4, _WORDS + _WORDS[::-1]),
        ("MyBuddy", "get_base_coords", (_PLACE, 1), 0xF0, _WORDS),
        ("MyBuddy", "base_to_single_coords", (_PLACE, 0), 0xF1, _WORDS),
        *((name, "is_power_on", (), 0x12, bytes([state])) for name in POWER for state in range(3)),
    ],
)
def test_result_of_reply_equals_that_of_the_maker(
    name: str, method: str, given: tuple[Any, ...], command: int, data: bytes
) -> None:
    theirs, mine = replied(name, method, given, command, data)
    assert theirs not in (None, -1)
    assert (mine, kinds(mine)) == (theirs, kinds(theirs))


@pytest.mark.parametrize(
    ("name", "method", "given", "command", "data", "theirs", "mine"),
    [
        # A read that failed is an error.
        ("MyCobot320", "get_servo_data", (1, 21), 0x53, b"\xff", -1, FAILED),
        # The library takes the faults of seven servos for error codes: 16, the angle, becomes 1.
        ("MyArm", "get_servo_status", (), 0xE4, bytes([16, 23, 32, 0, 1, 2, 5]),
         [1, 2, 3, 0, 1, 2, 5], [16, 23, 32, 0, 1, 2, 5]),
        # No joint has this angle, so the reply is damaged.
        *(
            (name, "get_angles", (), 0x20, words(*[18101] * joints), [181.01] * joints, FAILED)
            for name, joints in (
                *(("MyCobot280", 6), ("MyCobot280RDKX5", 6), ("MyCobot320", 6), ("MyCobot", 6)),
                *(("MechArm270", 6), ("MechArm", 6), ("MyArm", 7), ("MyPalletizer260", 4)),
            )
        ),
        ("MyBuddy", "get_angles", (1,), 0x20, words(*[18101] * 6), [181.01] * 6, FAILED),
    ],
)  # fmt: skip
def test_result_differs_from_that_of_the_maker_for_the_reason_given(
    name: str,
    method: str,
    given: tuple[int, ...],
    command: int,
    data: bytes,
    theirs: Any,
    mine: Any,
) -> None:
    assert replied(name, method, given, command, data) == [theirs, mine]


@pytest.mark.parametrize("register", range(46))
def test_register_of_320_is_read_as_by_the_maker(register: int) -> None:
    reply = frame(ALL_ROBOTS["MyCobot320"], 0xE9, tool(register, 2), 0)
    theirs, mine = both("MyCobot320", "get_pro_gripper", (register,), reply)
    if register in OF_A_JOINT:
        # The reply would not name the joint.
        assert (theirs.result, mine) == (2, Called(b"", REJECTED))
    else:
        assert (mine, type(mine.result)) == (theirs, type(theirs.result))


@pytest.mark.parametrize("value", [0, 1, 100, 101])
def test_registers_of_320_are_written_as_by_the_maker_or_rejected(value: int) -> None:
    reply = frame(ALL_ROBOTS["MyCobot320"], 0xE8, b"\1", 0)
    # The library checks no value of the registers that move the gripper or set its force.
    unchecked = {11, 27, 32, 36} if value > 100 else {32} if value == 0 else set()
    unchecked |= {13, 37, 38, 39} if value else set()
    for register in range(46):
        theirs, mine = both("MyCobot320", "set_pro_gripper", (register, value), reply)
        wanted = Called(b"", REJECTED) if register in unchecked else theirs
        assert (register, mine) == (register, wanted)
        assert register not in unchecked or theirs.result == 1


@pytest.mark.parametrize("name", ["MyPalletizer260", "MyPalletizerSocket"])
def test_palletizer_goes_home_with_all_four_joints(name: str) -> None:
    _, mine = both(name, "go_home", (), None)
    _, sent = both(name, "send_angles", ([0] * 4, 20), None)
    assert mine == Called(sent.written, None)


@pytest.mark.parametrize("state", [0, 1])
@pytest.mark.parametrize("own", [False, True])
@pytest.mark.parametrize("gripper", [1, 14, 254])
def test_gripper_of_450_is_switched_by_the_makers_frame(
    state: int, own: bool, gripper: int
) -> None:
    theirs, mine = both("Pro450Client", "set_pro_gripper_modbus", (state, own, gripper), b"")
    assert mine.written[:20] == theirs.written[:20] != b""
