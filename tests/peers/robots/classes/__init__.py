"""Find the maker's classes that are compared: each module of this package has one as ``ROBOT``."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from robots.robot import Robot

ROBOTS: dict[str, Robot] = {
    robot.peer: robot
    for robot in (
        import_module(f"{__name__}.{found.name}").ROBOT for found in iter_modules(__path__)
    )
}
