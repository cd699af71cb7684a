"""The myCobot Pro 400."""

from __future__ import annotations

from robots.classes.mercury_a1 import (
    DRIVING,
    LACKING,
    LOCAL_NAMES,
    OWN_ARGUMENTS,
    RULINGS,
    calls_of,
)
from robots.classes.pro630 import HALF, LISTED, UNREAD
from robots.crc_classes import SINGLE, opened_as
from robots.robot import Robot

_ENDS = "the maker's class has no method by which it would explain the end of a motion, and fails"
_FAILS = "the maker's class fails by mistake, after the request was accepted"
_LISTED: tuple[str, ...] = (
    "is_servo_enable",
    "get_comm_error_counts",
    "get_monitor_mode",
    "get_max_acc",
)
_LISTED += ("get_fusion_parameters", "get_pos_over_shoot")
_MOTIONS = tuple(
    name for name, kind in DRIVING["kinds"].items() if kind is int and "serial" not in name
)
_UNREAD = ("get_limit_switch", "get_robot_status", "power_on")
ROBOT = Robot(
    "Pro400",
    "pro400",
    further=("mercury_b1",),
    lacking=LACKING,
    calls=calls_of(6),
    local=LOCAL_NAMES,
    own_arguments=OWN_ARGUMENTS,
    rulings=RULINGS,
    opened=opened_as(SINGLE),
    **{
        **DRIVING,
        "unanswered": {
            **DRIVING["unanswered"],
            **UNREAD,
            **dict.fromkeys(_MOTIONS, _ENDS),
            **dict.fromkeys(_UNREAD, _FAILS),
        },
        "kinds": dict.fromkeys((*LISTED, *_LISTED), list),
    },
    not_read_back={**HALF, **dict.fromkeys((*_MOTIONS, "power_on"), _ENDS)},
)
