"""What the arm does when it is asked: one small function a command, registered by its name."""

from cobotwire.sim.behaviour import (
    drag,
    frames,
    gripper,
    io,
    jog,
    motion,
    network,
    planning,
    power,
    servo,
    system,
    upkeep,
)
from cobotwire.sim.behaviour.registry import BEHAVIOUR

__all__ = [
    "BEHAVIOUR",
    "drag",
    "frames",
    "gripper",
    "io",
    "jog",
    "motion",
    "network",
    "planning",
    "power",
    "servo",
    "system",
    "upkeep",
]
