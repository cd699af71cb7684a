"""Argument sets for every command, for our method and for pymycobot's.

They use lists and 0 or 1, since pymycobot takes no tuples, bools or enums. All numbers are inside
the limits of every class compared, and unchanged by its truncation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cobotwire.editions.mycobot import TABLE, TargetKind

Arguments = tuple[Any, ...]

_SWITCH: list[Arguments] = [(0,), (1,)]
_JOINTS: list[Arguments] = [(1,), (4,), (6,)]
_PINS: list[Arguments] = [(23, 0), (23, 1), (33, 1)]
_BASIC_PINS: list[Arguments] = [(2, 0), (5, 1), (35, 1)]
_ANGLES = [
    [0, 0, 0, 0, 0, 0],
    [1.5, -20.25, 30, -45.75, 120, -179.99],
    # The second number is FE FE and the third 00 FA: header and footer inside the data.
    [-165, -2.58, 2.5, -0.01, 0.01, 0.06],
]
_COORDS = [
    [0, 0, 0, 0, 0, 0],
    [160.3, -160.3, 412.6, 179.5, -90.25, 0.01],
    # -25.8 mm and -2.58 degrees: FE FE again.
    [-281.4, -25.8, -69.9, -2.58, 2.5, -180],
]
_JOG: list[Arguments] = [(1, 0, 1), (2, 1, 100), (6, 0, 50)]
_STEPS: list[Arguments] = [(1, 0.01, 1), (2, -90, 50), (4, -2.58, 100), (6, 120.5, 20)]
_SERVO: list[Arguments] = [(1, 20), (4, 22), (6, 24)]
_REFERENCES: list[Arguments] = [([1, 2, -3, 10, 20.5, -30],), ([50.5, -0.1, 99.9, 0, 0, 0.5],)]
_LIMITS: list[Arguments] = [(1, 90), (2, -45), (4, -1)]

_WITH_FIELDS: dict[str, list[Arguments]] = {
    "set_free_mode": _SWITCH,
    "set_fresh_mode": _SWITCH,
    "send_angle": _STEPS,
    "send_angles": [(angles, speed) for angles, speed in zip(_ANGLES, (1, 50, 100))],
    "is_in_position": [
        *((angles, 0) for angles in _ANGLES),
        *((coords, 1) for coords in _COORDS),
    ],
    "set_speed": [(0,), (50,), (100,)],
    "send_coord": [
        (1, 160.3, 1),
        (2, -25.8, 50),
        (3, -0.1, 100),
        (4, -2.58, 50),
        (5, 90.25, 50),
        (6, -0.01, 50),
    ],
    "send_coords": [
        (coords, speed, mode) for coords, speed, mode in zip(_COORDS, (1, 50, 100), (0, 1, 0))
    ],
    "jog_angle": _JOG,
    "jog_absolute": _STEPS,
    "jog_coord": _JOG,
    "jog_increment": [*_STEPS, (3, -325.35, 50), (3, 327.67, 50)],
    "set_encoder": [(1, 0), (4, 2048), (6, 4095)],
    "get_encoder": _JOINTS,
    "set_encoders": [([2048] * 6, 1), ([0, 4095, 254, 250, 65, 1024], 100)],
    "get_joint_min_angle": _JOINTS,
    "get_joint_max_angle": _JOINTS,
    "set_joint_min": _LIMITS,
    "set_joint_max": _LIMITS,
    "is_servo_enable": _JOINTS,
    "set_servo_data": [(1, 20, 1), (4, 22, 254), (6, 24, 250)],
    "get_servo_data": _SERVO,
    "set_servo_calibration": _JOINTS,
    "joint_brake": _JOINTS,
    "release_servo": _JOINTS,
    "focus_servo": _JOINTS,
    "set_pin_mode": _PINS,
    "set_digital_output": _PINS,
    "get_digital_input": [(19,), (39,)],
    "set_color": [(0, 0, 0), (255, 254, 250), (1, 2, 3)],
    "set_basic_output": _BASIC_PINS,
    "get_basic_input": [(2,), (36,)],
    "set_gripper_state": [(0, 1), (1, 100)],
    "set_gripper_value": [(0, 1), (50, 20), (100, 100)],
    "set_tool_reference": _REFERENCES,
    "set_world_reference": _REFERENCES,
    "set_reference_frame": _SWITCH,
    "set_end_type": _SWITCH,
    "set_server_port": [(1,), (9000,), (32767,)],
}

REQUESTS: dict[str, list[Arguments]] = {
    command.name: _WITH_FIELDS[command.name] if command.request[0].fields else [()]
    for command in TABLE.commands
}


def accepts(peer: str, command: str, arguments: Arguments) -> bool:
    """Return whether a class takes these arguments: the palletizer has only four joints and axes.

    The palletizer's class does not check six angles or encoders, and encodes them as we do.
    """
    if peer != "MyPalletizer260" or not arguments:
        return True
    if command == "is_in_position":
        return bool(arguments[1] == TargetKind.ANGLES)
    first = TABLE.command(command).request[0].fields[0].name
    return first not in ("joint", "axis") or bool(arguments[0] <= 4)


def requests_of(command: str, peer: str) -> Sequence[Arguments]:
    """Return the argument sets that a class accepts."""
    return [given for given in REQUESTS[command] if accepts(peer, command, given)]
