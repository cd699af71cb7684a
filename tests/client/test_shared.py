"""Threads or tasks share an arm: one-way requests are sent at once, queries take turns."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import MyCobot, ReplyTimeout, RetryPolicy
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import Traffic
from cobotwire.simulator import PtyServer, SimulatedArm
from scripted_peer import ScriptedPeer

STOP = bytes.fromhex("FE FE 02 29 FA")
REQUEST = bytes.fromhex("FE FE 02 20 FA")


def times_out(call: Callable[..., object], *arguments: object) -> None:
    with pytest.raises(ReplyTimeout):
        call(*arguments)


def test_one_way_request_is_sent_while_another_thread_waits(open_arm: Opener, peer_on: Any) -> None:
    with peer_on() as peer, open_arm(peer.url, timeout=2, retry=RetryPolicy(attempts=1)) as arm:
        calling = threading.Thread(target=times_out, args=(arm.get_angles,))
        calling.start()
        time.sleep(0.2)
        started = time.monotonic()
        arm.stop()
        assert time.monotonic() - started < 0.2
        time.sleep(0.1)
        assert peer.received == REQUEST + STOP
        assert calling.is_alive(), "the request still waits"
        calling.join()


def test_held_request_delays_no_other_thread(open_arm: Opener) -> None:
    powered = bytes.fromhex("FE FE 03 12 01 FA")
    with ScriptedPeer([], [powered]) as peer, open_arm(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        held = threading.Thread(target=times_out, args=(arm.get_encoder, 2))
        held.start()
        time.sleep(0.1)
        started = time.monotonic()
        assert arm.is_power_on() is True
        arm.stop()
        assert time.monotonic() - started < 0.5
        held.join()


def test_traffic_listener_may_call_the_arm() -> None:
    seen: list[bool] = []

    def watch(traffic: Traffic) -> None:
        if traffic.direction == "received" and not seen:
            seen.append(True)
            seen.append(arm.is_power_on())

    with PtyServer(SimulatedArm(TABLE)) as server, MyCobot(server.url, trace=watch) as arm:
        arm.get_angles()
    assert seen == [True, False]


def test_listening_thread_delays_no_other_thread(server: PtyServer) -> None:
    with MyCobot(server.url) as arm:
        listening = threading.Thread(target=arm.listen, args=(1.0,))
        listening.start()
        time.sleep(0.1)
        started = time.monotonic()
        arm.get_angles()
        assert time.monotonic() - started < 0.5
        listening.join()
