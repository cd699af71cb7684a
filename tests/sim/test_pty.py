"""The simulated arm's end of the line."""

from __future__ import annotations

import os
import select
import threading
import time

from cobotwire import MyCobot
from cobotwire.editions.mycobot import TABLE
from cobotwire.sim import PtyServer, SimulatedArm
from cobotwire.sim.line import UNREAD_LIMIT

ASK = bytes.fromhex("FE FE 02 20 FA")


def _ask_without_reading(server: PtyServer, times: int) -> int:
    """Write questions for as long as they are taken; gives how many were."""
    client = os.open(server.url, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        for count in range(times):
            if not select.select([], [client], [], 2.0)[1]:
                return count
            os.write(client, ASK * 20)
        return times
    finally:
        os.close(client)


def test_a_client_that_never_reads_does_not_block_the_arm_or_its_end() -> None:
    heard = 0

    def count(*_: object) -> None:
        nonlocal heard
        heard += 1

    with PtyServer(SimulatedArm(TABLE, watch=count)) as server:
        # Answers of 340 kB: many times what the terminal and the queue hold.
        assert _ask_without_reading(server, 1000) == 1000
        deadline = time.monotonic() + 20
        while heard < 20_000 and time.monotonic() < deadline:
            time.sleep(0.02)
        assert heard == 20_000
        [channel] = server._channels.values()
        assert channel.line.unread <= UNREAD_LIMIT + 4096 * 4
        started = time.monotonic()
        server.stop()
        server._thread.join(5.0)
        assert not server._thread.is_alive()
        assert time.monotonic() - started < 5.0


def test_the_next_client_is_served_after_one_that_never_read() -> None:
    with PtyServer(SimulatedArm(TABLE)) as server:
        _ask_without_reading(server, 400)
        with MyCobot(server.url) as arm:
            arm.power_on()
            assert arm.is_power_on() is True


def test_serving_ends_while_nothing_is_heard() -> None:
    server = PtyServer(SimulatedArm(TABLE))
    thread = threading.Thread(target=server.serve)
    thread.start()
    server.stop()
    thread.join(5.0)
    assert not thread.is_alive()
    server.close()
