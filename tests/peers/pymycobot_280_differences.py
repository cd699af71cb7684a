"""List every request of MyCobot280 that differs from ours in its own edition, with the ruling."""

from __future__ import annotations

from typing import Any

from pymycobot_difference import NOT_SENT, Difference

_NEAREST = "encode: the nearest step (0.29 x100 is 29); pymycobot cuts off the rest (28)"
_ROUNDED = "encode: the nearest step is held to the limits; pymycobot checks, then cuts off"
_LIMIT = "0x4C 0x4D: any tenth of a degree here; pymycobot takes whole degrees only"
_PORT = "0xB2: a port is 1..65535; pymycobot packs any signed word"
_TORQUE = "0x66 0x67: the torque comes after the type; alone, the arm reads it as the type"
_FLAG = "the list is closed here: modes and flags 0 1; pymycobot checks too little or nothing"
_UNSIGNED = "0x64: a frequency is not negative; pymycobot checks none of the numbers"
_SEVEN = "0x3E: six speeds for six joints; pymycobot takes seven too, with another LEN"
_SPACE = "0x81 0x83: a tool or pedestal may exceed the arm's workspace; pymycobot limits it"
_RADIANS = "0x22: the limits and speeds of send_angles; pymycobot checks none of them in radians"
_COUNT = "0x23 0x8D: six numbers; pymycobot sends any number of them"
_STEP = "0x33 0x34: what fits a signed word; pymycobot silently clamps the rest"
_SPAN = "0x33: any step that fits the wire; pymycobot rejects more than the joint's range"
_QUERIED = "0x2A: any target may be queried; pymycobot applies the limits of motion"
_TEXT = "0xB0: ASCII that reads in one way only; pymycobot sends any text, as UTF-8"

_OFF = [0, 0, 0, 0, 0, 0.29]
_OFF_READ = (0, 0, 0, 0, 0, 0.28)
_COORDS = [12.37, 0, 0, 0, 0, 0.29]
_COORDS_READ = (12.3, 0, 0, 0, 0, 0.28)
_ZERO = [0] * 6
_FAR = [0, 0, 500, 0, 0, 0]

Differences = dict[tuple[str, str], Difference]


def _same(
    command: str, topic: str, given: tuple[Any, ...], becomes: tuple[Any, ...] | str, ruling: str
) -> tuple[tuple[str, str], Difference]:
    """Describe a difference where both sides have the same method and arguments."""
    return (command, topic), Difference(given, command, given, becomes, ruling)


def _cut(command: str, given: tuple[Any, ...], *read: Any) -> tuple[tuple[str, str], Difference]:
    return _same(command, "cut off: " + str(given), given, read, _NEAREST)


TRUNCATIONS: Differences = dict(
    [
        _cut("send_angle", (1, 0.29, 50), 1, 0.28, 50),
        _cut("send_angles", (_OFF, 50), _OFF_READ, 50),
        _cut("send_radians", ([1, 0, 0, 0, 0, 0], 50), (57.29, 0, 0, 0, 0, 0), 50),
        _cut("send_coord", (4, 0.29, 50), 4, 0.28, 50),
        _cut("send_coord", (1, 12.37, 50), 1, 12.3, 50),
        _cut("send_coords", (_COORDS, 50), _COORDS_READ, 50),
        _cut("send_coords", (_COORDS, 50, 1), _COORDS_READ, 50, 1),
        _cut("is_in_position", (_OFF, 0), _OFF_READ, 0),
        _cut("is_in_position", (_COORDS, 1), _COORDS_READ, 1),
        _cut("jog_increment", (1, -0.29, 50), 1, -0.28, 50),
        _cut("jog_increment_angle", (1, -0.29, 50), 1, -0.28, 50),
        _cut("jog_increment_coord", (4, -0.29, 50), 4, -0.28, 50),
        _cut("jog_increment_coord", (3, -12.37, 50), 3, -12.3, 50),
        _cut("set_tool_reference", (_COORDS,), _COORDS_READ),
        _cut("set_world_reference", (_COORDS,), _COORDS_READ),
        _cut("angles_to_coords", (_OFF,), _OFF_READ),
        _cut("solve_inv_kinematics", (_COORDS, _ZERO), _COORDS_READ, (0,) * 6),
        _cut("solve_inv_kinematics", (_ZERO, _OFF), (0,) * 6, _OFF_READ),
    ]
)

LIMITS: Differences = dict(
    [
        _same("send_coord", "z 412.67", (3, 412.67, 50), (3, 412.6, 50), _ROUNDED),
        _same("jog_increment_coord", "z 482.67", (3, 482.67, 50), (3, 482.6, 50), _ROUNDED),
        _same("send_angle", "168.004", (1, 168.004, 50), NOT_SENT, _ROUNDED),
        _same("set_joint_min", "half a degree", (1, -12.5), NOT_SENT, _LIMIT),
        _same("set_joint_max", "half a degree", (1, 12.5), NOT_SENT, _LIMIT),
        _same("set_tool_reference", "500 mm", (_FAR,), NOT_SENT, _SPACE),
        _same("set_world_reference", "500 mm", (_FAR,), NOT_SENT, _SPACE),
        _same("is_in_position", "170 degrees", ([170, 0, 0, 0, 0, 0], 0), NOT_SENT, _QUERIED),
        _same("is_in_position", "500 mm", (_FAR, 1), NOT_SENT, _QUERIED),
        _same("jog_increment_angle", "300 degrees", (2, 300, 50), NOT_SENT, _SPAN),
        _same("jog_increment_angle", "330", (1, 330, 50), (1, 327.67, 50), _STEP),
        _same("jog_increment_angle", "-330", (1, -330, 50), (1, -327.68, 50), _STEP),
        _same("jog_increment_coord", "330", (6, 330, 50), (6, 327.67, 50), _STEP),
        _same("jog_increment_coord", "-330", (6, -330, 50), (6, -327.68, 50), _STEP),
        _same("send_radians", "3.2 radians", ([3.2, 0, 0, 0, 0, 0], 50), "bad-value", _RADIANS),
        _same("send_radians", "speed 0", (_ZERO, 0), "bad-value", _RADIANS),
        _same("set_server_port", "above 32767", (40000,), NOT_SENT, _PORT),
        _same("set_server_port", "0", (0,), "bad-value", _PORT),
        _same("set_server_port", "-1", (-1,), (65535,), _PORT),
    ]
)

UNCHECKED: Differences = dict(
    [
        _same("set_free_mode", "254", (254,), "bad-value", _FLAG),
        _same("set_vision_mode", "254", (254,), "bad-value", _FLAG),
        _same("release_all_servos", "2", (2,), "bad-value", _FLAG),
        _same("release_servo", "2", (1, 2), "bad-value", _FLAG),
        _same("send_coords", "mode 3", (_ZERO, 50, 3), "bad-value", _FLAG),
        _same("set_pwm_output", "-1 hertz", (1, -1, 128), "bad-value", _UNSIGNED),
        _same("set_gripper_state", "torque", (0, 50, None, 1), (0, 50, 1), _TORQUE),
        _same("set_gripper_state", "no torque", (0, 50, None, 0), "bad-value", _TORQUE),
        _same("set_gripper_value", "torque", (9, 50, None, 1), (9, 50, 1), _TORQUE),
        _same("set_gripper_value", "no torque", (9, 50, None, 0), "bad-value", _TORQUE),
        _same("set_encoders_drag", "seven speeds", (_ZERO, [0] * 7), "bad-length", _SEVEN),
        _same("angles_to_coords", "four angles", ([0] * 4,), "bad-length", _COUNT),
        _same("solve_inv_kinematics", "four angles", (_ZERO, [0] * 4), "bad-length", _COUNT),
    ]
)

DIFFERENCES: Differences = {**TRUNCATIONS, **LIMITS, **UNCHECKED}

# Texts that only pymycobot sends: the name, the password, and the ruling.
TEXTS = [
    ("Müller", "geheim", _TEXT),
    ("net'(work", "x", _TEXT),
    ("a\nb", "x", _TEXT),
]


def rejected_by_pymycobot(command: str) -> str | None:
    """Return the ruling for a legal request of ours that pymycobot rejects, or None."""
    rulings = {d.ruling for (name, _), d in LIMITS.items() if name == command}
    return next((r for r in sorted(rulings) if r in (_LIMIT, _SPACE, _QUERIED, _SPAN, _PORT)), None)
