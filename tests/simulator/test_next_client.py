"""Test that no bytes of a client that has left reach the next one, on a real pty and over TCP."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, Server, SimulatedArm, TcpServer
from cobotwire.transport.opening import open_transport

# The arm gives up an incomplete request after 0.2 s; a reply within this time did not wait for it.
AT_ONCE = 0.12
QUERY, OFF = bytes.fromhex("FE FE 02 12 FA"), bytes.fromhex("FE FE 03 12 00 FA")
MOVE = bytes.fromhex("FE FE 0F 22 03 E8 00 00 00 00 00 00 00 00 00 00 32 FA")
POWER_ON = bytes.fromhex("FE FE 02 10 FA")


@pytest.fixture
def arm() -> SimulatedArm:
    return SimulatedArm(TABLE, acks=False)


@pytest.fixture(params=["pty", "tcp"])
def server(request: pytest.FixtureRequest, arm: SimulatedArm) -> Iterator[Server]:
    with PtyServer(arm) if request.param == "pty" else TcpServer(arm.connect) as serving:
        yield serving


def _send(server: Server, data: bytes, seconds: float = 0.0) -> bytes:
    """Open the port, send ``data``, return what is received in ``seconds``, and close it."""
    transport = open_transport(server.url, 115200)
    try:
        transport.write(data)
        received, until = b"", time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0 and received != OFF:
            received += transport.read(left)
        return received
    finally:
        transport.close()


@pytest.mark.parametrize("cut", [2, 3, 9, 17])
def test_rest_of_a_request_that_another_client_began_moves_nothing(
    server: Server, arm: SimulatedArm, cut: int
) -> None:
    arm.state.powered, arm.state.enabled = True, [True] * 6
    _send(server, MOVE[:cut])
    time.sleep(0.02)
    _send(server, MOVE[cut:])
    time.sleep(0.05)
    assert not arm.state.angles.moving(arm.clock())


@pytest.mark.parametrize("cut", [3, 13])
def test_query_after_half_a_request_is_answered_at_once(server: Server, cut: int) -> None:
    _send(server, MOVE[:cut])
    time.sleep(0.02)
    started = time.monotonic()
    assert _send(server, QUERY, 5) == OFF
    assert time.monotonic() - started < AT_ONCE


def test_replies_that_a_client_did_not_read_do_not_reach_the_next_one(server: Server) -> None:
    _send(server, bytes.fromhex("FE FE 02 20 FA") * 20)
    time.sleep(0.02)
    assert _send(server, QUERY, 5) == OFF


def test_whole_request_of_a_client_that_leaves_at_once_is_obeyed(
    server: Server, arm: SimulatedArm
) -> None:
    _send(server, POWER_ON)
    until = time.monotonic() + 5
    while not arm.state.powered and time.monotonic() < until:
        time.sleep(0.005)
    assert arm.state.powered
