"""A session with a 280, as calls: commands of every family, values of all signs and sizes.

pymycobot and our clients have the same method names and arguments. ``fields`` are the values that
a call must send if they differ from its arguments.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cobotwire.conformance.client import ScriptLine
from cobotwire.editions.mycobot280 import TABLE


class Call(NamedTuple):
    """A call of a method; ``fields`` are the values of the request."""

    name: str
    arguments: tuple[Any, ...]
    fields: tuple[Any, ...]


def _call(name: str, *arguments: Any, fields: tuple[Any, ...] | None = None) -> Call:
    return Call(name, arguments, arguments if fields is None else fields)


RADIANS = [0.0, 0.25, -0.5, 1.0, -1.5, 0.1]

# No setter is repeated directly: a referee without a script would consider it resent.
SESSION: tuple[Call, ...] = (
    _call("power_on"),
    _call("is_power_on"),
    _call("is_controller_connected"),
    _call("get_system_version"),
    _call("get_basic_version"),
    _call("get_error_information"),
    _call("get_angles"),
    _call("get_coords"),
    _call("get_angles_coords"),
    _call("get_radians"),
    _call("set_fresh_mode", 1),
    _call("get_fresh_mode"),
    _call("send_angles", [10.5, -20.25, 30, -2.58, 2.5, -160], 50),
    _call("is_moving"),
    _call("send_angle", 2, -45.5, 30),
    _call("send_radians", RADIANS, 40, fields=([math.degrees(r) for r in RADIANS], 40)),
    _call("send_coords", [120.5, -80.3, 200.1, -90, 45.25, 179.5], 60, 1),
    _call("send_coord", 2, -33.3, 70),
    _call("send_coord", 5, -33.3, 70),
    _call("is_in_position", [1, 2, 3, 4, 5, 6], 0),
    _call("is_in_position", [100, 20, 30, 4, 5, 6], 1),
    _call("pause"),
    _call("is_paused"),
    _call("resume"),
    _call("stop"),
    _call("jog_angle", 1, 0, 20),
    _call("stop"),
    _call("jog_coord", 3, 1, 25),
    _call("stop"),
    _call("jog_increment", 1, 10.25, 90),
    _call("jog_increment_coord", 2, -25.8, 90),
    _call("set_encoder", 1, 1024, 50),
    _call("set_encoders", [1024, 2048, 2560, 2048, 2047, 2049], 50),
    *(_call("get_encoder", joint) for joint in range(1, 7)),
    _call("get_encoders"),
    *(_call("get_joint_min_angle", joint) for joint in (1, 6)),
    *(_call("get_joint_max_angle", joint) for joint in (1, 6)),
    _call("set_joint_min", 3, -120),
    _call("set_joint_max", 3, 120),
    *(_call("is_servo_enable", servo) for servo in (1, 2)),
    _call("is_all_servo_enable"),
    _call("get_servo_data", 2, 24),
    _call("get_servo_speeds"),
    _call("get_servo_voltages"),
    _call("get_servo_temps"),
    _call("set_pin_mode", 23, 1),
    _call("set_digital_output", 23, 1),
    _call("get_digital_input", 23),
    _call("set_basic_output", 5, 1),
    _call("get_basic_input", 5),
    _call("set_color", 255, 128, 1),
    _call("set_gripper_state", 1, 80),
    _call("set_gripper_value", 60, 90),
    _call("get_gripper_value"),
    _call("is_gripper_moving"),
    _call("set_tool_reference", [100, 20.5, -30, 45, 0, -90]),
    _call("get_tool_reference"),
    _call("set_world_reference", [100, 20.5, -30, 45, 0, -90]),
    _call("get_world_reference"),
    _call("set_reference_frame", 1),
    _call("get_reference_frame"),
    _call("set_end_type", 1),
    _call("get_end_type"),
    _call("set_movement_type", 1),
    _call("get_movement_type"),
    _call("get_tof_distance"),
    _call("release_servo", 6),
    _call("focus_servo", 6),
    _call("set_ssid_pwd", "home", "secret words", fields=()),
    _call("set_server_port", 9100),
    _call("power_off"),
)


def script() -> list[ScriptLine]:
    """Return the session as the referee's script."""
    return [
        ScriptLine(
            TABLE.command(call.name), call.fields, f"call {number} {call.name}{call.arguments}"
        )
        for number, call in enumerate(SESSION, 1)
    ]
