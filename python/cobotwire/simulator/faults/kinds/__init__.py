"""The kinds of faults. Importing this registers them all."""

from cobotwire.simulator.faults.kinds import additions, controller, damage, loss, timing, wiring
from cobotwire.simulator.faults.registry import KINDS

__all__ = ["KINDS", "additions", "controller", "damage", "loss", "timing", "wiring"]
