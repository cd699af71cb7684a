"""Serve a peer on a pseudo-terminal: a serial port that any program can open."""

from __future__ import annotations

import os
import tty
from functools import partial

from cobotwire.simulator.clock import RunningClock
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.server import Endpoint, Server


class PtyServer(Server):
    """Serves a peer on a pty while its ``with`` block runs; ``url`` is the port to open."""

    def __init__(self, peer: Peer, clock: RunningClock | None = None) -> None:
        """Create the pty; ``clock`` is the one that the peer uses; None: real time."""
        super().__init__(clock)
        master, slave = os.openpty()
        # Raw mode: a terminal would echo the requests and swallow some of their bytes. The slave
        # stays open here, so that clients can come and go.
        tty.setraw(slave)
        # A client that does not read must not block the server.
        os.set_blocking(master, False)
        self.url = os.ttyname(slave)

        def close() -> None:
            os.close(master)
            os.close(slave)

        endpoint = Endpoint(master, partial(os.read, master), partial(os.write, master), close)
        self._connect(endpoint, peer)
