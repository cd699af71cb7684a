"""No call takes longer than the client's deadline, on any line and with any number of callers.

A request that was not sent by then is never sent. The error says whether it was sent.
"""

from __future__ import annotations

import asyncio
import itertools
import threading
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, NamedTuple

import pytest

from attack import ends
from both_ways import InLoop, Opener
from cobotwire import LinkError, MyCobot, MyCobot280, ReplyTimeout, RetryPolicy, UsageError
from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE, AsyncMyCobot, GetEncoder
from cobotwire.editions.mycobot280 import AsyncMyCobot280
from cobotwire.session import Exchange, RequestReceived
from cobotwire.session.request import RequestEncoder
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.simulator.faults import Echo, Fault, Late
from cut_motion import ANGLES, MOTION, STOP
from faulty_arm import faulty_arm
from scripted_peer import ScriptedPeer
from session.one_caller import submit
from transport.ends import PtyEnd

TIMEOUT, DEADLINE = 0.4, 0.5
# The extra time that a call may take until its thread or task is scheduled.
MORE = 0.05
THREADS, TASKS, SECONDS = 8, 50, 0.7
ONCE = RetryPolicy(attempts=1)
CODEC = codecs.load(TABLE, "reference")
LATE = Late(seconds=0.3, jitter_seconds=0.6, probability=0.3)


class Call(NamedTuple):
    """The duration of a call, the number of times that its request was sent, and what it waited for
    at the end."""

    seconds: float
    attempts: int
    waited_for: str


class Measured:
    """Calls from several threads or tasks, each of which queries a joint until the time is over."""

    def __init__(self) -> None:
        self.calls: list[Call] = []
        self._until = time.monotonic() + SECONDS

    async def work(self, query: Callable[[int], Awaitable[object]], joint: int) -> None:
        while time.monotonic() < self._until:
            began, attempts, waited_for = time.monotonic(), 1, ""
            try:
                await query(joint)
            except ReplyTimeout as error:
                attempts, waited_for = error.attempts, error.waited_for
            self.calls.append(Call(time.monotonic() - began, attempts, waited_for))


def call_in_threads(arm: Any) -> list[Call]:
    async def query(joint: int) -> object:
        return arm.get_encoder(joint)

    measured = Measured()
    with ThreadPoolExecutor(THREADS) as pool:
        for number in range(THREADS):
            pool.submit(asyncio.run, measured.work(query, 1 + number % 6))
    return measured.calls


async def call_in_tasks(arm: Any) -> list[Call]:
    measured = Measured()
    await asyncio.gather(*(measured.work(arm.get_encoder, 1 + n % 6) for n in range(TASKS)))
    return measured.calls


def run_threads(url: str, **options: Any) -> list[Call]:
    with MyCobot(url, **options) as arm:
        return call_in_threads(arm)


def run_tasks(url: str, **options: Any) -> list[Call]:
    async def run() -> list[Call]:
        async with AsyncMyCobot(url, **options) as arm:
            return await call_in_tasks(arm)

    return asyncio.run(run())


@pytest.mark.stall(MORE / 2)
@pytest.mark.parametrize(
    ("run", "kind", "codec", "faults"),
    [
        (run_threads, "pty", "native", (LATE,)),
        (run_threads, "tcp", "reference", (LATE, Echo())),
        (run_tasks, "pty", "reference", (LATE, Echo())),
        (run_tasks, "tcp", "native", (LATE,)),
    ],
)
def test_calls_end_by_the_deadline_and_errors_report_correctly_what_was_sent(
    run: Callable[..., list[Call]], kind: str, codec: str, faults: tuple[Fault, ...]
) -> None:
    with faulty_arm(*faults, kind=kind) as (url, received):
        calls = run(url, timeout=TIMEOUT, deadline=DEADLINE, retry=ONCE, codec=codec)
        # A request that was sent after its deadline would arrive now.
        time.sleep(0.1)
    assert max(call.seconds for call in calls) < DEADLINE + MORE
    assert sum(call.attempts for call in calls) == sum(
        isinstance(event, RequestReceived) for event in received
    )
    assert any(call.attempts == 0 and call.waited_for for call in calls), "the line was contended"


@pytest.mark.usefixtures("repeated_in_rust")
def test_error_says_what_the_call_waited_for() -> None:
    exchange, encode = Exchange(CODEC), RequestEncoder(CODEC).encode
    first = submit(exchange, encode("get_encoder", (1,)), 0.0, ONCE, 0.2, 0.5)
    assert exchange.outgoing(0.0, drained=True)
    turn = submit(exchange, encode("get_angles", ()), 0.0, ONCE, 0.2, 0.1)
    exchange.wake(0.1)
    exchange.wake(0.2)
    hold = submit(exchange, encode("get_encoder", (2,)), 0.3, ONCE, 0.2, 0.8)
    reply = submit(exchange, encode("is_power_on", ()), 0.7, ONCE, 0.2, 0.8)
    assert exchange.outgoing(0.7, drained=True)
    exchange.advance(b"", 0.8)
    late = submit(exchange, encode("get_angles", ()), 0.8, ONCE, 0.2, 0.8)
    assert not exchange.outgoing(0.8, drained=True), "its caller no longer waits"
    submit(exchange, encode("is_power_on", ()), 0.8, ONCE, 0.2, 1.0)
    assert not exchange.outgoing(0.8, drained=True), "a late reply could be mistaken for its own"
    exchange.note_full(True)
    exchange.advance(b"", 0.9)
    texts = [str(pending._error) for pending in (first, turn, hold, reply, late)]
    assert texts == [
        "no reply to get_encoder(joint=1) within 0.200 s after 1 attempt; received meanwhile: "
        "nothing",
        "get_angles() was not sent: its deadline passed after 0.100 s while it waited for its turn",
        "get_encoder(joint=2) was not sent: its deadline passed after 0.500 s while a late reply "
        "to an earlier request could be mistaken for its own",
        "no reply to is_power_on() within its deadline, 0.100 s after 1 attempt; received "
        "meanwhile: nothing",
        "get_angles() was not sent: its deadline passed after 0.100 s while the line took no bytes",
    ]


def fill(arm: Any) -> int:
    """Send requests until the line takes none; return how many it took."""
    for sent in itertools.count():
        try:
            arm.send_angles(ANGLES, 50)
        except ReplyTimeout:
            return sent
    raise AssertionError


def test_full_line_delays_no_call_and_gets_only_the_stop_of_a_failed_block_later(
    open_arm: Opener,
) -> None:
    pty, received = PtyEnd(), list[bytes]()
    # Later than the deadline, earlier than a write fails.
    drained = threading.Timer(0.3, lambda: received.append(pty.drain()))

    def use(arm: Any) -> int:
        sent = fill(arm)
        for call in (arm.stop, arm.get_angles, lambda: arm.get_encoder(1)):
            began = time.monotonic()
            with pytest.raises(ReplyTimeout, match=r"was not sent: .* the line took no bytes"):
                call()
            assert time.monotonic() - began < 0.1 + MORE
        return sent

    sent = 0
    with suppress(ZeroDivisionError), open_arm(pty.url, deadline=0.1) as arm:
        sent = use(arm)
        drained.start()
        sent //= 0
    drained.join()
    pty.unplug()
    assert received == [MOTION * sent + STOP]


def test_partly_written_request_ends_by_the_deadline(open_arm: Opener) -> None:
    end = ends.PtyEnd()
    with open_arm(end.url, deadline=0.2) as arm:
        end.fill(10, lambda data: None)
        calls: list[Callable[[], object]] = [
            lambda: arm.send_angles(ANGLES, 50),
            lambda: arm.get_encoder(1),
        ]
        for call in calls:
            began = time.monotonic()
            with pytest.raises((LinkError, ReplyTimeout), match=r"only 1. of 21|was not sent"):
                call()
            assert time.monotonic() - began < 0.2 + MORE
    end.close()


@pytest.mark.parametrize("who", [MyCobot280, lambda *a, **o: InLoop(AsyncMyCobot280, *a, **o)])
def test_wait_for_an_acknowledgement_ends_by_the_deadline(who: Callable[..., Any]) -> None:
    with ScriptedPeer() as peer, who(peer.url, deadline=0.1) as arm:
        began = time.monotonic()
        with pytest.raises(ReplyTimeout, match=r"within its deadline, 0\.1.. s after 1 attempt"):
            arm.send_angles([0] * 6, 50, ack_within=1)
        assert time.monotonic() - began < 0.1 + MORE


def test_waited_motion_has_a_timeout_of_its_own(open_arm: Opener) -> None:
    with PtyServer(SimulatedArm(TABLE)) as server, open_arm(server.url, deadline=0.2) as arm:
        arm.power_on()
        began = time.monotonic()
        arm.move_angles([30, 0, 0, 0, 0, 0], 60, timeout=10)
        assert time.monotonic() - began > 0.2
        assert arm.get_angles()[0] == pytest.approx(30, abs=0.1)


@pytest.mark.parametrize("timeout", [0.1, 2.0])
def test_request_of_a_stream_has_the_deadline(open_arm: Opener, timeout: float) -> None:
    with faulty_arm(Late(seconds=0.2)) as (url, _), open_arm(url, deadline=0.1) as arm:
        stream = arm.stream(GetEncoder(1), rate=10, timeout=timeout)
        closing = threading.Timer(0.6, stream.close)
        closing.start()
        assert list(stream) == [], "each reply is too late"
        closing.join()


@pytest.mark.parametrize("deadline", [0, -1, float("nan"), 3600, True, "1"])
def test_deadline_is_a_number_of_seconds(deadline: Any) -> None:
    with pytest.raises(
        UsageError, match=r"deadline is .*; allowed: seconds above 0 and below 3600"
    ):
        AsyncMyCobot("/nope", deadline=deadline)
