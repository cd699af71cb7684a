"""The motion of axes over time, with limited speed and acceleration."""

from cobotwire.simulator.motion.axes import Axes

__all__ = ["Axes"]
