"""A simulated arm: state for every command, on a real pseudo-terminal or in memory."""

from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.clock import RunningClock, SteppedClock
from cobotwire.sim.memory import MemoryLink
from cobotwire.sim.pty import PtyPort, PtyServer
from cobotwire.sim.replayed import Heard, ReplayedArm

__all__ = [
    "Heard",
    "MemoryLink",
    "PtyPort",
    "PtyServer",
    "ReplayedArm",
    "RunningClock",
    "SimulatedArm",
    "SteppedClock",
]
