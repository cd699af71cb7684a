"""The maker's classes that are compared, by their names."""

from __future__ import annotations

from robots.classes import arms, closed_loop, mybuddy, pro450
from robots.robot import Robot

ROBOTS: dict[str, Robot] = {
    robot.peer: robot for module in (arms, closed_loop, mybuddy, pro450) for robot in module.ROBOTS
}
