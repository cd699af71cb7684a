"""One arm, many threads or tasks: orders at once, questions in turns, frames whole."""

from __future__ import annotations

import _thread
import asyncio
import os
import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
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


INTERRUPTED = """
import random, signal, sys, time
from cobotwire import MyCobot, CobotwireError
from cobotwire.editions.mycobot import TABLE
from cobotwire.sim import PtyServer, SimulatedArm
random.seed(int(sys.argv[1]))
signal.signal(signal.SIGALRM, signal.default_int_handler)
with PtyServer(SimulatedArm(TABLE)) as server, MyCobot(server.url) as arm:
    interrupts = 0
    until = time.monotonic() + 4
    while time.monotonic() < until:
        try:
            # One interrupt each time, which may still be on its way when the calls are done.
            signal.setitimer(signal.ITIMER_REAL, random.uniform(0.00001, 0.0006))
            for joint in range(1, 7):
                arm.set_color(joint, 1, 2)
                assert arm.get_joint_max_angle(joint) == 165.0
                assert arm.get_joint_min_angle(joint) == -165.0
            time.sleep(0.01)
        except KeyboardInterrupt:
            interrupts += 1
    for joint in range(1, 7):
        assert arm.get_joint_max_angle(joint) == 165.0
    print(interrupts)
"""


@pytest.mark.parametrize("seed", [1, 2])
def test_ctrl_c_anywhere_leaves_the_arm_usable(seed: int) -> None:
    result = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, str(seed)],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "PYTHONPATH": ""},
    )
    assert result.returncode == 0, result.stderr
    assert int(result.stdout) > 10


def test_ctrl_c_in_the_thread_that_reads_lets_another_one_read_on() -> None:
    answer = bytes.fromhex("FE FE 03 12 01 FA")
    with ScriptedPeer([0.6, answer]) as peer, MyCobot(peer.url, timeout=3) as arm:
        told: list[bool] = []
        asking = threading.Thread(target=lambda: told.append(arm.is_power_on()))
        threading.Timer(0.3, _thread.interrupt_main).start()
        threading.Timer(0.1, asking.start).start()
        with pytest.raises(KeyboardInterrupt):
            arm.get_coords()
        asking_ended = time.monotonic() + 5
        while not told and time.monotonic() < asking_ended:
            time.sleep(0.01)
        assert told == [True]


async def _cancelled(url: str) -> None:
    async with AsyncMyCobot(url, timeout=2) as arm:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.05):
                await arm.get_encoder(1)
        # The answer to the cancelled question comes at 0.2 s; it must not be taken for this one's.
        assert await arm.get_encoder(2) == 2


def test_a_cancelled_call_leaves_the_session_usable() -> None:
    one, two = (bytes.fromhex("FE FE 04 3B 00") + bytes([n]) + b"\xfa" for n in (1, 2))
    with ScriptedPeer([0.2, one], [two]) as peer:
        asyncio.run(_cancelled(peer.url))


async def _cancelled_at_any_time(url: str) -> None:
    chance = random.Random(5)
    async with AsyncMyCobot(url) as arm:
        for _ in range(150):
            work = asyncio.gather(
                *(arm.get_joint_max_angle(joint) for joint in range(1, 7)), arm.set_color(1, 2, 3)
            )
            await asyncio.sleep(chance.uniform(0, 0.001))
            work.cancel()
            with suppress(asyncio.CancelledError):
                await work
        assert [await arm.get_joint_max_angle(joint) for joint in range(1, 7)] == [165.0] * 6
        arm_line: Any = arm._line
        assert not arm_line._conversation._queue
        assert arm_line._conversation._asked is None


def test_tasks_may_be_cancelled_at_any_time() -> None:
    with PtyServer(SimulatedArm(TABLE)) as server:
        asyncio.run(_cancelled_at_any_time(server.url))


def _without_end(order: Callable[..., object]) -> None:
    while True:
        order(1, 2, 3)


def test_a_line_that_takes_no_bytes_is_a_link_error_in_time(open_arm: Opener) -> None:
    master, slave = os.openpty()
    try:
        with open_arm(os.ttyname(slave)) as arm:
            started = time.monotonic()
            # Nobody reads the other end: the buffer is full after some kilobytes.
            with pytest.raises(LinkError, match="no byte"):
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
