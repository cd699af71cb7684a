"""A client cannot finish a request that an earlier client began: on a pty, and over TCP."""

from __future__ import annotations

import time

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.transport.opening import open_transport

MOVE = bytes.fromhex("FE FE 0F 22 03 E8 00 00 00 00 00 00 00 00 00 00 32 FA")


@pytest.mark.parametrize("kind", ["pty", "tcp"])
@pytest.mark.parametrize("cut", [2, 3, 9, 17])
def test_rest_of_a_request_that_another_client_began_moves_nothing(kind: str, cut: int) -> None:
    arm = SimulatedArm(TABLE, acks=False, powered=True)
    with PtyServer(arm) if kind == "pty" else TcpServer(arm.connect) as server:
        for part, pause in ((MOVE[:cut], 0.02), (MOVE[cut:], 0.05)):
            transport = open_transport(server.url, 115200)
            transport.write(part)
            transport.close()
            time.sleep(pause)
    assert not arm.state.angles.moving(arm.clock())
