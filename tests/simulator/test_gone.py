"""Test that clients notice a peer that disconnects, on each kind of port."""

from __future__ import annotations

import pytest

from cobotwire import LinkError
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, SteppedClock, TcpServer
from cobotwire.simulator.peer import Peer, PeerDisconnected


class Disconnecting:
    """A peer that disconnects when it receives something, or after a time."""

    def __init__(self, wait: float | None = None) -> None:
        self.wait = wait

    def receive(self, data: bytes) -> bytes:
        if self.wait is None:
            raise PeerDisconnected
        return b""

    def flush(self) -> bytes:
        raise PeerDisconnected


@pytest.mark.parametrize("wait", [None, 0.05])
def test_pty_of_a_disconnected_peer_is_closed_and_serving_ends(wait: float | None) -> None:
    with PtyServer(Disconnecting()) as server, MyCobot280(server.url) as arm:
        with pytest.raises(LinkError):
            arm.get_angles()


@pytest.mark.parametrize("wait", [None, 0.05])
def test_tcp_client_of_a_disconnected_peer_is_dropped_and_the_next_can_connect(
    wait: float | None,
) -> None:
    peers: list[Peer] = [Disconnecting(wait), SimulatedArm(TABLE)]
    with TcpServer(lambda: peers.pop(0)) as server:
        with MyCobot280(server.url) as arm:
            with pytest.raises(LinkError):
                arm.get_angles()
        with MyCobot280(server.url) as arm:
            assert arm.is_power_on() is False


@pytest.mark.parametrize("wait", [None, 0.05])
def test_memory_transport_of_a_disconnected_peer_is_closed(wait: float | None) -> None:
    clock = SteppedClock()
    arm = MyCobot280(MemoryTransport(Disconnecting(wait), clock))
    for message in ("the peer is gone", "it is closed"):
        with pytest.raises(LinkError, match=message):
            arm.get_angles()
