"""Serve a peer to programs on this machine: on a pty, or over TCP on Windows."""

from __future__ import annotations

from cobotwire.simulator.clock import RunningClock
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.pty import HAS_PTYS, PtyServer
from cobotwire.simulator.server import Server
from cobotwire.simulator.tcp import TcpServer


def local_server(peer: Peer, clock: RunningClock | None = None) -> Server:
    """Return a server on a pty; on Windows, which has none, on a free TCP port of loopback."""
    if HAS_PTYS:
        return PtyServer(peer, clock)
    return TcpServer(lambda: peer, clock=clock)
