"""Streams on real ptys and real TCP: what is sampled, what is missed, and how they end."""

from __future__ import annotations

import _thread
import asyncio
import threading
import time
from itertools import islice, pairwise
from typing import Any

import pytest

from both_ways import Opener, openers
from cobotwire import AsyncMyCobot, LinkError, MyCobot, RetryPolicy, UsageError
from cobotwire.editions.mycobot import Angles, Coords
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.sim import PtyServer, SimulatedArm
from scripted_peer import ScriptedPeer

QUESTION = bytes.fromhex("FE FE 02 20 FA")
ANSWER = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
# What was not answered holds the next question so long, from its asking.
QUICK = RetryPolicy(grace=0.06)
NEWER = openers(MyCobot280, AsyncMyCobot280)


def test_samples_are_numbered_timed_and_typed(open_arm: Opener, server: PtyServer) -> None:
    with open_arm(server.url) as arm:
        stream = arm.stream("get_angles", ("get_encoder", 2), "get_coords", rate=50)
        started = time.monotonic()
        samples = list(islice(stream, 25))
        assert [sample.number for sample in samples] == list(range(25))
        moments = [started]
        for sample in samples:
            angles, encoder, coords = sample.values
            assert type(angles) is Angles
            assert type(coords) is Coords
            assert encoder == sample["get_encoder", 2] == 2048
            for reading in sample.readings:
                moments += [reading.asked_at, reading.answered_at]
        assert moments == sorted(moments)
        report = stream.report
        assert report.samples == 25
        # A busy machine wakes late now and then; nothing else is missed here.
        assert report.unanswered == 0
        assert report.reached > 40


@pytest.mark.parametrize("opening", list(NEWER))
def test_every_query_streams_what_its_method_gives(opening: str) -> None:
    names = [
        command.name
        for command in TABLE.commands
        if command.safety == "query" and not command.request[0].fields
    ]
    with PtyServer(SimulatedArm(TABLE)) as server, NEWER[opening](server.url) as arm:
        sample = next(arm.stream(*names, rate=10))
        for name in names:
            once = getattr(arm, name)()
            assert sample[name] == once
            assert type(sample[name]) is type(once)
    assert len(names) > 20


def test_a_rate_beyond_the_line_is_told_and_not_pretended(open_arm: Opener, peer_on: Any) -> None:
    with peer_on(*[[0.02, ANSWER]] * 20) as peer, open_arm(peer.url) as arm:
        stream = arm.stream("get_angles", rate=200)
        samples = list(islice(stream, 15))
        assert stream.report.reached < 50
        assert stream.report.overrun > 15
        gaps = [b.asked_at - a.asked_at for a, b in pairwise(samples)]
        assert min(gaps) >= 0.02


def test_a_slow_consumer_misses_samples_and_the_arm_is_not_asked_for_them(
    open_arm: Opener, peer_on: Any
) -> None:
    with peer_on(*[[ANSWER]] * 9) as peer, open_arm(peer.url) as arm:
        stream = arm.stream("get_angles", rate=50)
        for sample in islice(stream, 5):
            assert time.monotonic() - sample.answered_at < 0.1
            time.sleep(0.105)
        assert peer.heard == 5 * QUESTION
        assert stream.report.unread >= 18
        assert stream.report.samples == 5


def test_silence_and_nonsense_are_counted_and_the_stream_goes_on(
    open_arm: Opener, peer_on: Any
) -> None:
    powered, nonsense = (bytes.fromhex(f"FE FE 03 12 {value} FA") for value in ("01", "05"))
    script = [[powered], [], [powered], [nonsense], [powered]]
    with peer_on(*script) as peer, open_arm(peer.url, retry=QUICK) as arm:
        stream = arm.stream("is_power_on", rate=50, timeout=0.05)
        assert [sample.values for sample in islice(stream, 3)] == [(True,)] * 3
        report = stream.report
        assert (report.samples, report.unanswered) == (3, 2)
        assert report.samples + report.missed == report.slots
        # Never asked twice: the next slot asks again anyway.
        assert peer.heard == 5 * bytes.fromhex("FE FE 02 12 FA")


def test_a_link_that_goes_away_ends_the_stream(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([ANSWER], [ANSWER], [None]) as peer, open_arm(peer.url) as arm:
        stream = arm.stream("get_angles", rate=50)
        assert len(list(islice(stream, 2))) == 2
        with pytest.raises(LinkError):
            next(stream)
        assert list(stream) == []
        assert stream.report.samples == 2


@pytest.mark.parametrize(
    ("queries", "words"),
    [
        ([], "queries, which are is_power_on"),
        (["send_angles"], "queries, which are is_power_on"),
        (["get_angels"], "did you mean get_angles"),
        (["get_angles", "get_angles"], "each query once"),
        ([("get_encoder",)], "what its method takes"),
        ([("get_encoder", 9)], "joint is 9"),
        ([7], "a name, or a tuple"),
    ],
)
def test_what_cannot_be_streamed_is_refused_before_a_byte_is_sent(
    open_arm: Opener, queries: list[Any], words: str
) -> None:
    with ScriptedPeer() as peer, open_arm(peer.url) as arm:
        with pytest.raises(UsageError, match=words):
            arm.stream(*queries, rate=10)
        with pytest.raises(UsageError, match="timeout"):
            arm.stream("get_angles", rate=10, timeout=0)
        assert peer.heard == b""


def test_a_stream_ends_by_break_and_by_close(open_arm: Opener, server: PtyServer) -> None:
    with open_arm(server.url) as arm:
        stream = arm.stream("get_angles", rate=100)
        for _ in stream:
            break
        # It can be gone on with; the arm is free meanwhile, and afterwards.
        assert arm.is_power_on() is False
        assert next(stream).number == 1
        slow = arm.stream("get_angles", rate=0.01)
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


def test_others_use_the_arm_while_it_streams(open_arm: Opener, server: PtyServer) -> None:
    with open_arm(server.url) as arm:
        over = threading.Event()
        asked = []

        def others() -> None:
            while not over.is_set():
                asked.append(arm.get_encoder(3))
                arm.set_color(1, 2, 3)
                time.sleep(0.005)

        thread = threading.Thread(target=others)
        thread.start()
        samples = list(islice(arm.stream("get_angles", "get_coords", rate=100), 50))
        over.set()
        thread.join()
        assert [sample.number for sample in samples] == list(range(50))
        assert set(asked) == {2048}


def test_ctrl_c_leaves_arm_and_stream_usable() -> None:
    with ScriptedPeer([ANSWER], [0.6, ANSWER], *[[ANSWER]] * 5) as peer, MyCobot(peer.url) as arm:
        stream = arm.stream("get_angles", rate=50)
        next(stream)
        threading.Timer(0.3, _thread.interrupt_main).start()
        with pytest.raises(KeyboardInterrupt):
            next(stream)
        assert type(arm.get_angles()) is Angles
        assert next(stream).number == 1


def test_a_cancelled_task_leaves_arm_and_stream_usable() -> None:
    async def drive(url: str) -> None:
        async with AsyncMyCobot(url) as arm:
            stream = arm.stream("get_angles", rate=50)
            await anext(stream)
            with pytest.raises(TimeoutError):
                await asyncio.wait_for(anext(stream), 0.3)
            assert type(await arm.get_angles()) is Angles
            assert (await anext(stream)).number == 1

    with ScriptedPeer([ANSWER], [0.6, ANSWER], *[[ANSWER]] * 5) as peer:
        asyncio.run(drive(peer.url))
