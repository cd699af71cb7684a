"""Names of joints, for arguments that are the number of a joint."""

from __future__ import annotations

from enum import IntEnum


class Joint(IntEnum):
    """A joint by its number: ``arm.send_angle(Joint.J2, 30, speed=20)``.

    J1 is the base. An arm has as many as its edition says; the last one is the flange.
    """

    J1 = 1
    J2 = 2
    J3 = 3
    J4 = 4
    J5 = 5
    J6 = 6
    J7 = 7
