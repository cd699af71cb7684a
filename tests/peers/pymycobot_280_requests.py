"""Argument sets for every command of the 280, for our method and for pymycobot's.

Most are corners of the edition's own table: the lowest and the highest value of every field, for
each value of its selector. The rest are chosen by hand.
"""

from __future__ import annotations

import math

from cobotwire.editions.mycobot280 import TABLE
from pymycobot_requests import REQUESTS as OLDER
from robots.arguments import Arguments, as_called, corners

_ANGLES = [[0] * 6, [-168, -140, -150, -150, -155, -180], [168, 140, 150, 150, 160, 180]]
_COORDS = [
    [0] * 6,
    [-281.4, -281.4, -70, -180, -180, -180],
    [281.4, 281.4, 412.6, 180, 180, 180],
    # Header and footer inside the data: FE FE and 00 FA.
    [-25.8, 25.0, -0.1, -2.58, 2.5, 0.1],
]
_WORDS = [[-327.68, 327.67, -2.58, 2.5, 0.01, -0.01]]

# In addition to the corners, or instead of corners that pymycobot rejects.
_BY_HAND: dict[str, list[Arguments]] = {
    "send_angle": [(1, 1.5, 20), (2, -2.58, 1), (3, -0.1, 100)],
    "send_angles": [([1.5, -20.25, 30, -45.75, 120, -179.99], 50)],
    "send_radians": [([0, math.pi / 4, -math.pi / 4, math.pi / 2, -math.pi / 2, math.pi], 50)],
    "send_coord": [(1, 160.3, 1), (2, -25.8, 50), (3, -0.1, 100), (6, -2.58, 50)],
    "send_coords": [(coords, 50) for coords in _COORDS] + [(coords, 1, 1) for coords in _COORDS],
    "is_in_position": [(r, 0) for r in _ANGLES] + [(r, 1) for r in _COORDS],
    "jog_increment": [(1, -2.58, 50), (2, 0.1, 50)],
    "jog_increment_angle": [(1, -2.58, 50), (2, -280, 50), (2, 280, 50), (5, 315, 1)],
    "jog_increment_coord": [(1, -25.8, 50), (3, 0.1, 50), (4, -2.58, 50)],
    "set_servo_data": [(1, 24, 250), (7, 24, 254, 1), (7, 5, 4096, 0)],
    "set_encoders_drag": [([0, 4096, 254, 250, 65, 1024], [0, 6000, 254, 250, 65, 1024])],
    "set_tool_reference": [(coords,) for coords in _COORDS],
    "set_world_reference": [(coords,) for coords in _COORDS],
    "set_server_port": [(1,), (9000,), (32767,)],
    "set_color": [(255, 254, 250), (1, 2, 3)],
    "angles_to_coords": [(row,) for row in _WORDS],
    "solve_inv_kinematics": [(row, angles) for row in _COORDS for angles in _ANGLES],
    "set_ssid_pwd": [("MyCobotWiFi2.4G", "mycobot123"), ("my home net", "two words"), ("", "")],
}
# Commands with corners that pymycobot rejects; pymycobot_280_differences lists its bounds.
_NO_CORNERS = {"is_in_position", "set_tool_reference", "set_world_reference", "set_server_port"}
_NO_CORNERS |= {"jog_increment_angle"}
# Commands with the same arguments as in the older edition, within the limits of this one.
_AS_BEFORE = {"send_angles", "jog_angle", "jog_coord", "jog_increment", "set_tool_reference"}
_AS_BEFORE |= {"set_world_reference", "set_servo_data", "get_servo_data", "set_pin_mode"}


def _requests(name: str) -> list[Arguments]:
    found = [] if name in _NO_CORNERS else [
        as_called(TABLE.command(name), variant, values)
        for variant in TABLE.command(name).request for values in corners(variant)
    ]  # fmt: skip
    if name == "set_ssid_pwd":
        found = []
    return found + (OLDER[name] if name in _AS_BEFORE else []) + _BY_HAND.get(name, [])


# The document's commands that pymycobot's class for the 280 lacks; its class for the palletizer has
# them.
LACKING = ["jog_stop"]

REQUESTS: dict[str, list[Arguments]] = {
    command.name: _requests(command.name)
    for command in TABLE.commands
    if command.name not in LACKING
}

# Calls that pymycobot completes with defaults or composes of several: its method and arguments, and
# ours. If it sends more than one request, the first counts.
COMPOSED: list[tuple[str, Arguments, str, Arguments]] = [
    ("is_in_position", (_ANGLES[1],), "is_in_position", (_ANGLES[1], 0)),
    ("set_color", (), "set_color", (0, 0, 0)),
    ("go_home", (), "send_angles", ([0] * 6, 10)),
    ("gripper_stop", (), "set_gripper_value", (0, 0, 1, 1)),
    ("is_torque_gripper", (), "get_servo_data", (7, 1)),
    ("sync_send_angles", (_ANGLES[2], 50), "send_angles", (_ANGLES[2], 50)),
    ("sync_send_coords", (_COORDS[3], 50), "send_coords", (_COORDS[3], 50, 0)),
    ("sync_send_coords", (_COORDS[3], 50, 1), "send_coords", (_COORDS[3], 50, 1)),
]
# Public names of the class that send nothing to the arm.
LOCAL = {"check_python_version", "close", "crc_check", "crc_robot_class", "open", "wait"}
LOCAL |= {"gpio_init", "gpio_output"}  # these drive pins of the Raspberry Pi
