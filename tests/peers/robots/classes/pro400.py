"""The myCobot Pro 400."""

from __future__ import annotations

from robots.classes.mercury_a1 import (
    LACKING,
    OWN_ARGUMENTS,
    calls_of,
)
from robots.crc_classes import SINGLE, opened_as
from robots.robot import Robot

ROBOT = Robot(
    "Pro400",
    "pro400",
    further=("mercury_b1",),
    lacking=LACKING,
    calls=calls_of(6),
    own_arguments=OWN_ARGUMENTS,
    opened=opened_as(SINGLE),
)
