"""List every request of pymycobot that differs from ours, with the ruling for ours."""

from __future__ import annotations

from pymycobot_difference import (
    ALL,
    ALWAYS,
    BOTH,
    M280,
    NEWER,
    PALLETIZER,
    Difference,
    Row,
    other_variant,
    same_call,
)
from pymycobot_value_differences import REACH, TRUNCATIONS

_LIMIT = "0x4C 0x4D, disputed: x100 in this edition; pymycobot x10, as in mycobot280"
_REFERENCE = "0x81 0x83, disputed: x, y, z x100 in this edition; pymycobot x10, as in mycobot280"
_SPEED_BYTE = "0x3A: no speed byte in this edition; mycobot280 has one"
_SHORT = "the class is for an arm of four joints: its rows are two words shorter"
_TRAILING = "this edition has no such trailing byte; mycobot280 has it as an optional one"
_RPY = "0x31: absolute joint angle here; in mycobot280 a jog about an axis"
_STEP = "0x34: jog stop here; in mycobot280 a step of a coordinate"
_FORWARD = "0x23 has no data here; with six words it is mycobot280's forward kinematics"
_NO_MODE = "0x25: LEN 10 with a mode here; newer firmware also takes LEN 0F without"
_EVERY = "0x57: joints are 1..6; newer firmware takes 0 as all of them"

_SIX = [0] * 6
_FOUR = [0] * 4
_REFERENCED = ([10, 20.5, -30, 45, 0, -90],)
_REFERENCED_READ = ((1.0, 2.05, -3.0, 45.0, 0.0, -90.0),)

NEVER_EQUAL = [
    other_variant(ALL, "set_encoder", ALWAYS, (4, 9), "set_encoder", (4, 9, 50), _SPEED_BYTE),
    same_call(NEWER, "set_joint_min", ALWAYS, (1, -90), (1, -9.0), _LIMIT),
    same_call(NEWER, "set_joint_max", ALWAYS, (1, 90), (1, 9.0), _LIMIT),
    same_call((M280,), "set_tool_reference", ALWAYS, _REFERENCED, _REFERENCED_READ, _REFERENCE),
    same_call((M280,), "set_world_reference", ALWAYS, _REFERENCED, _REFERENCED_READ, _REFERENCE),
    other_variant(
        (PALLETIZER,), "send_coords", ALWAYS, (_SIX, 50, 0), "send_coords", (_FOUR, 50), _SHORT
    ),
]

OTHER_MEANINGS = [
    other_variant((M280,), "jog_absolute", "jog_rpy", (1, 9, 50), "jog_rpy", (1, 1, 50), _RPY),
    other_variant((M280,), "jog_stop", "a step", (), "jog_increment_coord", (1, 9, 50), _STEP),
    other_variant(BOTH, "get_coords", "of angles", (), "angles_to_coords", (_SIX,), _FORWARD),
    Row(ALL, "focus_servo", "all", Difference((6,), "focus_all_servos", (), "bad-value", _EVERY)),
]

SHORT_ROWS = [
    other_variant((PALLETIZER,), command, "four joints", ours, command, theirs, _SHORT)
    for command, ours, theirs in [
        ("send_angles", (_SIX, 50), (_FOUR, 50)),
        ("is_in_position", (_SIX, 1), (_FOUR, 1)),
        ("set_encoders", (_SIX, 50), (_FOUR, 50)),
    ]
]

TRAILING_BYTES = [
    other_variant(
        BOTH, "send_coords", "no mode", (_SIX, 50, 0), "send_coords", (_SIX, 50), _NO_MODE
    ),
    *(
        other_variant(peers, command, "a trailing byte", ours, command, (*ours, 1), _TRAILING)
        for peers, command, ours in [
            (ALL, "release_all_servos", ()),
            (ALL, "release_servo", (1,)),
            (ALL, "set_gripper_state", (0, 50)),
            (ALL, "set_gripper_value", (9, 50)),
            (NEWER, "get_gripper_value", ()),
            (ALL, "get_servo_data", (1, 24)),
            (ALL, "set_servo_data", (1, 24, 9)),
        ]
    ),
]

_ROWS = [*NEVER_EQUAL, *OTHER_MEANINGS, *SHORT_ROWS, *TRAILING_BYTES, *TRUNCATIONS, *REACH]

DIFFERENCES: dict[tuple[str, str, str], Difference] = {
    (row.command, peer, row.topic): row.difference for row in _ROWS for peer in row.peers
}


def never_equal(command: str, peer: str) -> bool:
    """Return whether a class uses another variant or scale for a command, for all arguments."""
    return (command, peer, ALWAYS) in DIFFERENCES
