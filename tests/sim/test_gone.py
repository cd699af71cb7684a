"""A peer that takes its line away: on each kind of port, whoever is there hears that it is gone."""

from __future__ import annotations

import pytest

from cobotwire import LinkError
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.sim import MemoryLink, PtyPort, SimulatedArm, SteppedClock, TcpPort
from cobotwire.sim.peer import LineGone, Peer


class Going:
    """Takes its line away when it hears something, or when its time has come."""

    def __init__(self, wait: float | None = None) -> None:
        self.wait = wait

    def receive(self, data: bytes) -> bytes:
        if self.wait is None:
            raise LineGone
        return b""

    def flush(self) -> bytes:
        raise LineGone


@pytest.mark.parametrize("wait", [None, 0.05])
def test_a_pty_is_gone_and_serving_ends_in_order(wait: float | None) -> None:
    with PtyPort(Going()) as server, MyCobot280(server.url) as arm:
        with pytest.raises(LinkError):
            arm.get_angles()


@pytest.mark.parametrize("wait", [None, 0.05])
def test_over_tcp_one_client_is_hung_up_on_and_the_next_may_come(wait: float | None) -> None:
    peers: list[Peer] = [Going(wait), SimulatedArm(TABLE)]
    with TcpPort(lambda: peers.pop(0)) as server:
        with MyCobot280(server.url) as arm:
            with pytest.raises(LinkError):
                arm.get_angles()
        with MyCobot280(server.url) as arm:
            assert arm.is_power_on() is False


@pytest.mark.parametrize("wait", [None, 0.05])
def test_a_link_in_memory_is_closed(wait: float | None) -> None:
    clock = SteppedClock()
    arm = MyCobot280(MemoryLink(Going(wait), clock))
    for said in ("the peer is gone", "it is closed"):
        with pytest.raises(LinkError, match=said):
            arm.get_angles()
