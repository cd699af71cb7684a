"""One arm, many threads or tasks: orders at once, questions in turns, frames whole."""

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
from cobotwire.session import Asked, Traffic
from cobotwire.session.device import DeviceEvent
from cobotwire.sim import PtyServer, SimulatedArm
from links import Recorder
from scripted_peer import ScriptedPeer

STOP = bytes.fromhex("FE FE 02 29 FA")
ASK = bytes.fromhex("FE FE 02 20 FA")


def in_vain(call: Callable[..., object], *arguments: object) -> None:
    with pytest.raises(ReplyTimeout):
        call(*arguments)


def test_an_order_goes_out_while_another_thread_waits(open_arm: Opener, peer_on: Any) -> None:
    with peer_on() as peer, open_arm(peer.url, timeout=2, retry=RetryPolicy(tries=1)) as arm:
        asking = threading.Thread(target=in_vain, args=(arm.get_angles,))
        asking.start()
        time.sleep(0.2)
        started = time.monotonic()
        arm.stop()
        assert time.monotonic() - started < 0.2
        time.sleep(0.1)
        assert peer.heard == ASK + STOP
        assert asking.is_alive(), "and the question waits on"
        asking.join()


def test_a_held_question_keeps_nobody_else_waiting(open_arm: Opener) -> None:
    powered = bytes.fromhex("FE FE 03 12 01 FA")
    with ScriptedPeer([], [powered]) as peer, open_arm(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        held = threading.Thread(target=in_vain, args=(arm.get_encoder, 2))
        held.start()
        time.sleep(0.1)
        started = time.monotonic()
        assert arm.is_power_on() is True
        arm.stop()
        assert time.monotonic() - started < 0.5
        held.join()


def test_many_threads_get_their_own_answers_and_frames_do_not_mix(open_arm: Opener) -> None:
    heard: list[DeviceEvent] = []
    simulated = SimulatedArm(TABLE, watch=lambda event, answer: heard.append(event))
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
    assert all(isinstance(event, Asked) for event in heard), "no noise, nothing malformed"
    assert len(heard) >= 6 * 30 * 4 + 1


def test_a_watcher_may_ask_the_arm_itself() -> None:
    seen: list[bool] = []

    def watch(traffic: Traffic) -> None:
        if traffic.direction == "heard" and not seen:
            seen.append(True)
            seen.append(arm.is_power_on())

    with PtyServer(SimulatedArm(TABLE)) as server, MyCobot(server.url, trace=watch) as arm:
        arm.get_angles()
    assert seen == [True, False]


def _without_end(order: Callable[..., object]) -> None:
    while True:
        order(1, 2, 3)


def test_a_line_that_takes_no_bytes_is_a_link_error_in_time(open_arm: Opener) -> None:
    master, slave = os.openpty()
    try:
        with open_arm(os.ttyname(slave)) as arm:
            started = time.monotonic()
            # Nobody reads the other end: the buffer is full after some kilobytes.
            with pytest.raises(LinkError, match="does not take what is written"):
                _without_end(arm.set_color)
            assert time.monotonic() - started < 8
    finally:
        os.close(master)
        os.close(slave)


def test_a_transport_of_ones_own_needs_nothing_but_the_protocol() -> None:
    async def drive() -> bytes:
        link = Recorder()
        async with AsyncMyCobot(link) as arm:
            await arm.power_on()
            with pytest.raises(ReplyTimeout):
                await arm.get_angles()
        return link.written

    assert asyncio.run(drive()) == bytes.fromhex("FE FE 02 10 FA") + 3 * ASK


def test_who_listens_holds_nobody_up(server: PtyServer) -> None:
    with MyCobot(server.url) as arm:
        listening = threading.Thread(target=arm.listen, args=(1.0,))
        listening.start()
        time.sleep(0.1)
        started = time.monotonic()
        arm.get_angles()
        assert time.monotonic() - started < 0.5
        listening.join()
