"""The left arm of a Mercury B1 or X1."""

from __future__ import annotations

from robots.classes.mercury_a1 import (
    LACKING,
    LOCAL_NAMES,
    OWN_ARGUMENTS,
    RULINGS,
    calls_of,
)
from robots.crc_classes import opened_as
from robots.robot import Call, Robot, Ruling

_HEAD = "joint 12 turns to 245 degrees, as on the maker's page; its class wants 220"
_PLACE = [300, 0, 200, 90, 0, -90]
ROBOT = Robot(
    "Mercury (B1, X1)",
    "mercury_b1",
    local=LOCAL_NAMES,
    lacking={**LACKING, "is_in_position_base_coords": "is_in_position with the mode 2"},
    own_arguments=OWN_ARGUMENTS,
    calls=[
        *calls_of(7),
        Call("is_in_position", (_PLACE, 2), "is_in_position_base_coords", (_PLACE,)),
    ],
    rulings={
        **RULINGS,
        "jog_increment_angle": [Ruling("increment angle value not right", _HEAD)],
        "send_angle": [Ruling("angle value not right", _HEAD)],
    },
    opened=opened_as("/dev/left_arm"),
)
