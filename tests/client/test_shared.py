"""Threads or tasks share an arm: one-way requests are sent at once, queries take turns."""

from __future__ import annotations

import asyncio
import os
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import LinkError, MyCobot, ReplyTimeout, RetryPolicy
from cobotwire.editions.mycobot import TABLE, AsyncMyCobot
from cobotwire.session import RequestReceived, Traffic
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer, SimulatedArm
from recording_transport import RecordingTransport
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


def test_many_threads_get_their_own_replies_and_frames_do_not_mix(open_arm: Opener) -> None:
    events: list[DeviceEvent] = []
    simulated = SimulatedArm(TABLE, on_event=lambda event, reply: events.append(event))
    failures: list[BaseException] = []

    def work(joint: int) -> None:
        try:
            for number in range(30):
                arm.set_color(joint, number, 0)
                arm.set_encoder(joint, 100 * joint + number)
                assert arm.get_joint_max_angle(joint) == 165.0
                assert arm.get_servo_data(joint, 21) == 10
        except BaseException as error:
            failures.append(error)

    with PtyServer(simulated) as server, open_arm(server.url, timeout=5) as arm:
        threads = [threading.Thread(target=work, args=(joint,)) for joint in range(1, 7)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        arm.get_angles()
    assert failures == []
    assert all(isinstance(event, RequestReceived) for event in events), (
        "each event is a legal request"
    )
    assert len(events) >= 6 * 30 * 4 + 1


def test_traffic_listener_may_call_the_arm() -> None:
    seen: list[bool] = []

    def watch(traffic: Traffic) -> None:
        if traffic.direction == "received" and not seen:
            seen.append(True)
            seen.append(arm.is_power_on())

    with PtyServer(SimulatedArm(TABLE)) as server, MyCobot(server.url, trace=watch) as arm:
        arm.get_angles()
    assert seen == [True, False]


def test_port_that_accepts_no_bytes_is_a_link_error(open_arm: Opener) -> None:
    master, slave = os.openpty()
    started = 0.0

    def repeat(call: Callable[..., object]) -> None:
        nonlocal started
        while True:
            started = time.monotonic()
            call(1, 2, 3)

    try:
        with open_arm(os.ttyname(slave)) as arm:
            # Nothing reads the other end, so the buffer is full after some kilobytes.
            with pytest.raises(LinkError, match=r"cannot be written: .* taken in"):
                repeat(arm.set_color)
            assert time.monotonic() - started < 8
    finally:
        os.close(master)
        os.close(slave)


def test_client_accepts_any_object_with_the_transport_protocol() -> None:
    async def drive() -> bytes:
        transport = RecordingTransport()
        async with AsyncMyCobot(transport) as arm:
            await arm.power_on()
            with pytest.raises(ReplyTimeout):
                await arm.get_angles()
        return transport.written

    assert asyncio.run(drive()) == bytes.fromhex("FE FE 02 10 FA") + 3 * REQUEST


def test_listening_thread_delays_no_other_thread(server: PtyServer) -> None:
    with MyCobot(server.url) as arm:
        listening = threading.Thread(target=arm.listen, args=(1.0,))
        listening.start()
        time.sleep(0.1)
        started = time.monotonic()
        arm.get_angles()
        assert time.monotonic() - started < 0.5
        listening.join()
