"""The left arm of a Mercury B1 or X1."""

from __future__ import annotations

from robots.classes.mercury_a1 import (
    LACKING,
    OWN_ARGUMENTS,
    calls_of,
)
from robots.crc_classes import opened_as
from robots.robot import Call, Robot

_PLACE = [300, 0, 200, 90, 0, -90]
ROBOT = Robot(
    "Mercury (B1, X1)",
    "mercury_b1",
    lacking={**LACKING, "is_in_position_base_coords": "is_in_position with the mode 2"},
    own_arguments=OWN_ARGUMENTS,
    calls=[
        *calls_of(7),
        Call("is_in_position", (_PLACE, 2), "is_in_position_base_coords", (_PLACE,)),
    ],
    opened=opened_as("/dev/left_arm"),
)
