"""How axes move over time: with a speed and an acceleration that they keep to."""

from cobotwire.sim.motion.axes import Axes

__all__ = ["Axes"]
