"""What the arm does for each command: one small function each, registered by its request type."""

from cobotwire.simulator.behaviour import (  # noqa: F401  (importing them registers them)
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
from cobotwire.simulator.behaviour.registry import BEHAVIOURS, Behaviour, behaviour

__all__ = ["BEHAVIOURS", "Behaviour", "behaviour"]
