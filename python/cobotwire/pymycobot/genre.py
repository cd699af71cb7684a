"""Numbers of joints and axes, under the maker's names."""

from __future__ import annotations

from enum import Enum


class Angle(Enum):
    """The number of a joint; programs use ``Angle.J1.value``."""

    J1 = 1
    J2 = 2
    J3 = 3
    J4 = 4
    J5 = 5
    J6 = 6


class Coord(Enum):
    """The number of an axis; programs use ``Coord.X.value``."""

    X = 1
    Y = 2
    Z = 3
    Rx = 4
    Ry = 5
    Rz = 6
