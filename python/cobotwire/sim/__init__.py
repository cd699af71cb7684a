"""A simulated arm: state for every command, on a pseudo-terminal, over TCP or in memory."""

from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.clock import RunningClock, SteppedClock
from cobotwire.sim.memory import MemoryLink
from cobotwire.sim.pty import PtyPort, PtyServer
from cobotwire.sim.replayed import Heard, ReplayedArm
from cobotwire.sim.server import Server
from cobotwire.sim.tcp import TcpPort, TcpServer

__all__ = [
    "Heard",
    "MemoryLink",
    "PtyPort",
    "PtyServer",
    "ReplayedArm",
    "RunningClock",
    "Server",
    "SimulatedArm",
    "SteppedClock",
    "TcpPort",
    "TcpServer",
]
