"""A simulated arm, or whatever answers, on a pseudo-terminal: a port that any program opens."""

from __future__ import annotations

import os
import tty
from functools import partial

from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.channel import End
from cobotwire.sim.clock import RunningClock
from cobotwire.sim.peer import Peer
from cobotwire.sim.server import Server


class PtyPort(Server):
    """Serves a peer on a pty while its ``with`` block runs; ``url`` is the port to open."""

    def __init__(self, peer: Peer, clock: RunningClock | None = None) -> None:
        super().__init__(clock)
        master, slave = os.openpty()
        # Raw, or the terminal would echo the requests and eat some of their bytes. The slave stays
        # open here, so that a client may come and go.
        tty.setraw(slave)
        # A client that does not read must not keep the arm from hearing, nor from ending.
        os.set_blocking(master, False)
        self.url = os.ttyname(slave)

        def unplug() -> None:
            os.close(master)
            os.close(slave)

        self._connect(
            End(master, partial(os.read, master), partial(os.write, master), unplug), peer
        )

    def _ready(self, descriptor: int, events: int) -> None:
        self._hear(descriptor, events)


class PtyServer(PtyPort):
    """Serves a simulated arm."""

    def __init__(self, arm: SimulatedArm, clock: RunningClock | None = None) -> None:
        super().__init__(arm, clock)
        self.arm = arm
