"""A simulated arm: state for every command, on a real pseudo-terminal or in memory."""

from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.pty import PtyServer

__all__ = ["PtyServer", "SimulatedArm"]
