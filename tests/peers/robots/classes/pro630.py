"""The myCobot Pro 630."""

from __future__ import annotations

from robots.classes.mercury_a1 import (
    LACKING,
    LOCAL_NAMES,
    OWN_ARGUMENTS,
    RULINGS,
    calls_of,
)
from robots.crc_classes import SINGLE, opened_as
from robots.robot import Call, Robot, Ruling

# These switch pins of the computer in the arm, or raise that the robot does not support them.
_PINS = {"get_basic_input", "set_basic_output", "power_on_only"}
_PINS |= {"get_monitor_mode", "set_monitor_mode", "joint_number", "pin_numbered_mapping_table"}
_PINS |= {"arm_span_maximum", "power_control_1", "power_control_2"}
_SERVO = "the class has the method, but checks for joints; the servos 11 and 12 are those of a head"
_ZERO = [0] * 6
ROBOT = Robot(
    "Pro630",
    "pro630",
    further=("mercury_b1",),
    lacking=LACKING,
    calls=[*calls_of(6), Call("send_angles_sync", (_ZERO, 50), "send_angles", (_ZERO, 50))],
    local=LOCAL_NAMES | _PINS,
    own_arguments={**OWN_ARGUMENTS, "power_on": [(1,)]},
    rulings={
        **RULINGS,
        "get_servo_data": [Ruling("servo_id not right", _SERVO)],
        "set_servo_data": [Ruling("servo_id not right", _SERVO)],
    },
    opened=opened_as(SINGLE),
)
