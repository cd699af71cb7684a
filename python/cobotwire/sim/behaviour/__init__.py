"""What the arm does when it is asked: one small function a command, registered by its name."""

from cobotwire.sim.behaviour import frames, gripper, io, jog, motion, network, power, servo
from cobotwire.sim.behaviour.registry import BEHAVIOUR

__all__ = ["BEHAVIOUR", "frames", "gripper", "io", "jog", "motion", "network", "power", "servo"]
