"""Queries are asked again, orders never; and late and second replies answer nothing else."""

from __future__ import annotations

import time
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import ReplyTimeout, RetryPolicy
from cobotwire.editions.mycobot import Angles
from cobotwire.session import Traffic

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
READ = Angles(1.4, 0.61, -0.26, -1.93, 1.75, -1.75)
ASK = bytes.fromhex("FE FE 02 20 FA")
ONCE = RetryPolicy(tries=1)


def test_a_silent_arm_is_a_timeout_that_says_what_was_asked(open_arm: Opener, peer_on: Any) -> None:
    with peer_on() as peer, open_arm(peer.url, timeout=0.1, retry=ONCE) as arm:
        started = time.monotonic()
        with pytest.raises(
            ReplyTimeout, match=r"no answer to get_angles within 0\.1.*asked once.*nothing"
        ) as caught:
            arm.get_angles()
        assert 0.09 < time.monotonic() - started < 0.4
        assert isinstance(caught.value, TimeoutError)
        assert (caught.value.command, caught.value.tries) == ("get_angles", 1)
        time.sleep(0.05)
        assert peer.heard == ASK, "asked once, and once only"


def test_a_query_is_asked_three_times_within_the_documents_500_ms(
    open_arm: Opener, peer_on: Any
) -> None:
    with peer_on() as peer, open_arm(peer.url) as arm:
        started = time.monotonic()
        with pytest.raises(ReplyTimeout, match=r"get_encoder\(joint=2\).*asked 3 times"):
            arm.get_encoder(2)
        assert 0.48 < time.monotonic() - started < 0.9
        time.sleep(0.05)
        assert peer.heard == 3 * bytes.fromhex("FE FE 03 3B 02 FA")


def test_a_lost_reply_is_asked_for_again(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([], [ANGLES]) as peer, open_arm(peer.url) as arm:
        started = time.monotonic()
        assert arm.get_angles() == READ
        assert time.monotonic() - started < 0.4
        assert peer.heard == 2 * ASK


def test_an_order_is_sent_exactly_once_whatever_happens(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([b"cmd_len error\r\n"]) as peer, open_arm(peer.url) as arm:
        arm.jog_increment(1, 5.0, 50)
        time.sleep(0.6)
        assert peer.heard == bytes.fromhex("FE FE 06 33 01 01 F4 32 FA")


def test_a_late_reply_does_not_answer_the_next_question(open_arm: Opener, peer_on: Any) -> None:
    stale = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    traffic: list[Traffic] = []
    with peer_on([0.15, stale], [ANGLES]) as peer:
        with open_arm(peer.url, timeout=0.1, trace=traffic.append) as arm:
            with pytest.raises(ReplyTimeout):
                arm.get_angles()
            time.sleep(0.15)
            assert arm.get_angles() == READ
    kinds = [type(one.event).__name__ for one in traffic if one.direction == "heard"]
    assert kinds == ["Late", "Answered"]


def test_the_second_reply_to_a_question_that_was_asked_twice_is_late(
    open_arm: Opener, peer_on: Any
) -> None:
    other = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    with peer_on([0.2, ANGLES, 0.05, other], [], [ANGLES]) as peer, open_arm(peer.url) as arm:
        assert arm.get_angles() == READ
        assert arm.get_angles() == READ, "the reply between them answers neither"


def test_a_reply_that_comes_twice_answers_once(open_arm: Opener, peer_on: Any) -> None:
    other = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    with peer_on([other + other], [ANGLES]) as peer, open_arm(peer.url) as arm:
        assert arm.get_angles() == Angles(0, 0, 0, 0, 0, 0)
        assert arm.get_angles() == READ
