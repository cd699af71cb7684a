"""Test the server of a pseudo-terminal."""

from __future__ import annotations

import os
import select
import threading
import time

from cobotwire import MyCobot
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.simulator.client_connection import UNREAD_LIMIT

QUERY = bytes.fromhex("FE FE 02 20 FA")


def _send_without_reading(server: PtyServer, times: int) -> int:
    """Write requests as long as the port accepts them; return how many it accepted."""
    client = os.open(server.url, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        for count in range(times):
            if not select.select([], [client], [], 2.0)[1]:
                return count
            os.write(client, QUERY * 20)
        return times
    finally:
        os.close(client)


class _Requests:
    """Count the requests that a simulated arm has taken."""

    def __init__(self) -> None:
        self.taken = 0

    def __call__(self, *_: object) -> None:
        self.taken += 1

    def wait_for(self, number: int) -> None:
        """Wait until the arm has taken this many requests; fail after 20 s."""
        deadline = time.monotonic() + 20
        while self.taken < number and time.monotonic() < deadline:
            time.sleep(0.02)
        assert self.taken == number


def test_client_that_never_reads_blocks_neither_the_arm_nor_stop() -> None:
    requests = _Requests()
    with PtyServer(SimulatedArm(TABLE, on_event=requests)) as server:
        # Replies of 340 kB, many times the capacity of the terminal and the queue.
        assert _send_without_reading(server, 1000) == 1000
        requests.wait_for(20_000)
        [client] = server._clients.values()
        assert client.connection.unread <= UNREAD_LIMIT + 4096 * 4
        started = time.monotonic()
        server.stop()
        server._thread.join(5.0)
        assert not server._thread.is_alive()
        assert time.monotonic() - started < 5.0


def test_next_client_is_served_after_one_that_never_read() -> None:
    requests = _Requests()
    with PtyServer(SimulatedArm(TABLE, on_event=requests)) as server:
        _send_without_reading(server, 400)
        # Wait until the arm has taken all requests from the terminal, and the server has dropped
        # the unread replies. A client that reads meanwhile would report that another program reads
        # from its port.
        requests.wait_for(8000)
        deadline = time.monotonic() + 20
        while server._opened and time.monotonic() < deadline:
            time.sleep(0.02)
        time.sleep(0.1)
        with MyCobot(server.url) as arm:
            arm.power_on()
            assert arm.is_power_on() is True


def test_stop_ends_serving_while_nothing_arrives() -> None:
    server = PtyServer(SimulatedArm(TABLE))
    thread = threading.Thread(target=server.serve)
    thread.start()
    server.stop()
    thread.join(5.0)
    assert not thread.is_alive()
    server.close()
