"""Queries are repeated, one-way requests never; a late or second reply goes to no other request."""

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
REQUEST = bytes.fromhex("FE FE 02 20 FA")
ONCE = RetryPolicy(attempts=1)


def test_silent_arm_raises_a_timeout_that_names_the_request(open_arm: Opener, peer_on: Any) -> None:
    with peer_on() as peer, open_arm(peer.url, timeout=0.1, retry=ONCE) as arm:
        started = time.monotonic()
        with pytest.raises(
            ReplyTimeout, match=r"no reply to get_angles\(\) within 0\.1.*after 1 attempt;.*nothing"
        ) as caught:
            arm.get_angles()
        assert 0.09 < time.monotonic() - started < 0.4
        assert isinstance(caught.value, TimeoutError)
        assert (caught.value.command, caught.value.attempts) == ("get_angles", 1)
        time.sleep(0.05)
        assert peer.received == REQUEST, "sent exactly once"


def test_query_is_repeated_after_a_lost_reply(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([], [ANGLES]) as peer, open_arm(peer.url) as arm:
        started = time.monotonic()
        assert arm.get_angles() == READ
        assert time.monotonic() - started < 0.4
        assert peer.received == 2 * REQUEST


def test_one_way_request_is_sent_exactly_once(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([b"cmd_len error\r\n"]) as peer, open_arm(peer.url) as arm:
        arm.jog_increment(1, 5.0, 50)
        time.sleep(0.6)
        assert peer.received == bytes.fromhex("FE FE 06 33 01 01 F4 32 FA")


def test_late_reply_is_not_paired_with_the_next_request(open_arm: Opener, peer_on: Any) -> None:
    stale = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    traffic: list[Traffic] = []
    with peer_on([0.15, stale], [ANGLES]) as peer:
        with open_arm(peer.url, timeout=0.1, trace=traffic.append) as arm:
            with pytest.raises(ReplyTimeout):
                arm.get_angles()
            time.sleep(0.15)
            assert arm.get_angles() == READ
    kinds = [type(one.event).__name__ for one in traffic if one.direction == "received"]
    assert kinds == ["LateReply", "ReplyMatched"]


def test_second_reply_to_a_repeated_query_is_late(open_arm: Opener, peer_on: Any) -> None:
    other = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    with peer_on([0.2, ANGLES, 0.05, other], [], [ANGLES]) as peer, open_arm(peer.url) as arm:
        assert arm.get_angles() == READ
        assert arm.get_angles() == READ, "the reply between them belongs to neither"


def test_duplicated_reply_is_used_once(open_arm: Opener, peer_on: Any) -> None:
    other = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    with peer_on([other + other], [ANGLES]) as peer, open_arm(peer.url) as arm:
        assert arm.get_angles() == Angles(0, 0, 0, 0, 0, 0)
        assert arm.get_angles() == READ
