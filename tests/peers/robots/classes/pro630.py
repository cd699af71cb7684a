"""The myCobot Pro 630."""

from __future__ import annotations

from robots.classes.mercury_a1 import (
    LACKING,
    OWN_ARGUMENTS,
    calls_of,
)
from robots.crc_classes import SINGLE, opened_as
from robots.robot import LOCAL, Call, Robot

# These switch pins of the computer in the arm, or raise that the robot does not support them.
_PINS = {"get_basic_input", "set_basic_output", "power_on_only"}
_PINS |= {"get_monitor_mode", "set_monitor_mode"}
_ZERO = [0] * 6
ROBOT = Robot(
    "Pro630",
    "pro630",
    further=("mercury_b1",),
    lacking=LACKING,
    calls=[*calls_of(6), Call("send_angles_sync", (_ZERO, 50), "send_angles", (_ZERO, 50))],
    local=LOCAL | _PINS,
    own_arguments={**OWN_ARGUMENTS, "power_on": [(1,)]},
    opened=opened_as(SINGLE),
)
