"""Stream over real ptys and real TCP: samples, missed periods, and the end of a stream."""

from __future__ import annotations

import _thread
import threading
import time
from itertools import islice, pairwise
from typing import Any

import pytest

from both_ways import Opener, openers
from cobotwire import LinkError, MyCobot, RetryPolicy, UsageError
from cobotwire.editions.mycobot import TABLE, Angles, Coords
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
from cobotwire.protocol.messages import Request
from cobotwire.simulator import PtyServer, SimulatedArm
from scripted_peer import ScriptedPeer

REQUEST = bytes.fromhex("FE FE 02 20 FA")
REPLY = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
GET_ANGLES: Request[Any] = TABLE.request_type("get_angles")()
GET_COORDS: Request[Any] = TABLE.request_type("get_coords")()
IS_POWER_ON: Request[Any] = TABLE.request_type("is_power_on")()
get_encoder: Any = TABLE.request_type("get_encoder")
# After an unanswered request, an equal request is held for this many seconds.
QUICK = RetryPolicy(grace=0.06)
NEWER = openers(MyCobot280, AsyncMyCobot280)


def test_samples_are_numbered_timed_and_typed(open_arm: Opener, server: PtyServer) -> None:
    with open_arm(server.url) as arm:
        # The rate leaves room for the delays of a busy machine.
        stream = arm.stream(GET_ANGLES, get_encoder(2), GET_COORDS, rate=20)
        started = time.monotonic()
        samples = list(islice(stream, 25))
        assert [sample.number for sample in samples] == list(range(25))
        times = [started]
        for sample in samples:
            angles, encoder, coords = sample.values
            assert type(angles) is Angles
            assert type(coords) is Coords
            assert encoder == sample[get_encoder(2)] == 2048
            for reading in sample.readings:
                times += [reading.requested_at, reading.replied_at]
        assert times == sorted(times)
        report = stream.report
        assert report.samples == 25
        assert report.unanswered == 0
        # A busy machine sometimes wakes late, once for many periods; no other period may be missed.
        assert sum(b.period == a.period + 1 for a, b in pairwise(samples)) >= 19


@pytest.mark.parametrize("opening", list(NEWER))
def test_stream_yields_the_result_of_each_querys_method(opening: str) -> None:
    requests = {
        command.name: command.request_type()
        for command in TABLE_280.commands
        if command.safety == "query" and not command.request[0].fields
    }
    with PtyServer(SimulatedArm(TABLE_280)) as server, NEWER[opening](server.url) as arm:
        sample = next(arm.stream(*requests.values(), rate=10))
        for name, request in requests.items():
            once = getattr(arm, name)()
            assert sample[request] == once
            assert type(sample[request]) is type(once)
    assert len(requests) > 20


def test_rate_beyond_the_line_is_reported_as_overrun(open_arm: Opener, peer_on: Any) -> None:
    with peer_on(*[[0.02, REPLY]] * 20) as peer, open_arm(peer.url) as arm:
        stream = arm.stream(GET_ANGLES, rate=200)
        samples = list(islice(stream, 15))
        assert stream.report.reached < 50
        assert stream.report.overrun > 15
        gaps = [b.requested_at - a.requested_at for a, b in pairwise(samples)]
        assert min(gaps) >= 0.02


def test_samples_missed_by_a_slow_consumer_are_not_requested(
    open_arm: Opener, peer_on: Any
) -> None:
    with peer_on(*[[REPLY]] * 9) as peer, open_arm(peer.url) as arm:
        stream = arm.stream(GET_ANGLES, rate=50)
        for sample in islice(stream, 5):
            assert time.monotonic() - sample.replied_at < 0.2
            time.sleep(0.205)
        assert peer.received == 5 * REQUEST
        assert stream.report.unread >= 36
        assert stream.report.samples == 5


def test_missing_and_illegal_replies_are_counted_and_the_stream_continues(
    open_arm: Opener, peer_on: Any
) -> None:
    powered, nonsense = (bytes.fromhex(f"FE FE 03 12 {value} FA") for value in ("01", "05"))
    # The peer closes the line at a sixth request, so that a late fifth reply fails at once.
    script = [[powered], [], [powered], [nonsense], [powered], [None]]
    with peer_on(*script) as peer, open_arm(peer.url, retry=QUICK) as arm:
        stream = arm.stream(IS_POWER_ON, rate=20, timeout=0.2)
        assert [sample.values for sample in islice(stream, 3)] == [(True,)] * 3
        report = stream.report
        assert (report.samples, report.unanswered) == (3, 2)
        assert report.samples + report.missed == report.periods
        # Each request is sent once: the next period sends it again anyway.
        assert peer.received == 5 * bytes.fromhex("FE FE 02 12 FA")


def test_lost_transport_ends_the_stream(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([REPLY], [REPLY], [None]) as peer, open_arm(peer.url) as arm:
        stream = arm.stream(GET_ANGLES, rate=50)
        assert len(list(islice(stream, 2))) == 2
        with pytest.raises(LinkError):
            next(stream)
        assert list(stream) == []
        assert stream.report.samples == 2


@pytest.mark.parametrize(
    ("requests", "words"),
    [
        ([], "needs a query: is_power_on"),
        ([TABLE.request_type("stop")()], "stop, which is not a query"),
        ([TABLE_280.request_type("get_angles_plan")()], "get_angles_plan"),
        ([GET_ANGLES, get_encoder(1), GET_ANGLES], "each query once"),
        ([get_encoder(9)], "joint is 9"),
        ([7], "a request such as"),
        (["get_angles"], "a request such as"),
    ],
)
def test_wrong_request_is_rejected_before_a_byte_is_sent(
    open_arm: Opener, requests: list[Any], words: str
) -> None:
    with ScriptedPeer() as peer, open_arm(peer.url) as arm:
        with pytest.raises(UsageError, match=words):
            arm.stream(*requests, rate=10)
        with pytest.raises(UsageError, match="timeout"):
            arm.stream(GET_ANGLES, rate=10, timeout=0)
        assert peer.received == b""


def test_break_and_close_end_iteration_and_leave_the_arm_usable(
    open_arm: Opener, server: PtyServer
) -> None:
    with open_arm(server.url) as arm:
        stream = arm.stream(GET_ANGLES, rate=100)
        for _ in stream:
            break
        # Iteration can continue; the arm is free meanwhile, and afterwards.
        assert arm.is_power_on() is False
        assert next(stream).number == 1
        slow = arm.stream(GET_ANGLES, rate=0.01)
        next(slow)
        threading.Timer(0.1, slow.close).start()
        started = time.monotonic()
        assert list(slow) == []
        assert time.monotonic() - started < 1.0
        report = slow.report
        time.sleep(0.02)
        assert slow.report == report
        assert (report.samples, report.missed) == (1, 0)
        assert type(arm.get_angles()) is Angles


def test_ctrl_c_leaves_arm_and_stream_usable() -> None:
    with ScriptedPeer([REPLY], [0.6, REPLY], *[[REPLY]] * 5) as peer, MyCobot(peer.url) as arm:
        stream = arm.stream(GET_ANGLES, rate=50)
        next(stream)
        threading.Timer(0.3, _thread.interrupt_main).start()
        with pytest.raises(KeyboardInterrupt):
            next(stream)
        assert type(arm.get_angles()) is Angles
        assert next(stream).number == 1
