"""A late reply on a real pseudo-terminal never becomes the value of another joint."""

from __future__ import annotations

import time
from contextlib import suppress

import pytest

from cobotwire import MyCobot, ReplyTimeout
from cobotwire.client import Traffic
from cobotwire.simulator.faults import Late, Lost
from faulty_arm import faulty_arm

TIMEOUT = 0.1


def test_reply_50_ms_late_is_not_used_for_another_joint() -> None:
    traffic: list[Traffic] = []
    late = Late(seconds=TIMEOUT + 0.05, nth=(1,))
    with (
        faulty_arm(late) as (url, _),
        MyCobot(url, timeout=TIMEOUT, trace=traffic.append) as arm,
    ):
        started = time.monotonic()
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        for joint in (2, 3):
            # On a busy machine the call may time out, but it never returns a wrong value.
            with suppress(ReplyTimeout):
                assert arm.get_encoder(joint) == joint
        # It holds them as long as a copy of it could come: some lines double replies.
        assert 0.9 < time.monotonic() - started < 1.9
    directions = [(t.direction, t.data) for t in traffic]
    assert directions.index(("received", bytes.fromhex("FE FE 04 3B 00 01 FA"))) < directions.index(
        ("sent", bytes.fromhex("FE FE 03 3B 02 FA"))
    )


def test_reply_after_727_ms_is_not_used_for_another_joint() -> None:
    late = Late(seconds=0.727, nth=(1,))
    with faulty_arm(late) as (url, _), MyCobot(url, timeout=TIMEOUT) as arm:
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        assert arm.get_encoder(2) == 2


def test_lost_reply_holds_the_next_query_but_not_a_one_way_request() -> None:
    lost = Lost(nth=(1,))
    with faulty_arm(lost) as (url, _), MyCobot(url, timeout=TIMEOUT) as arm:
        sent_at = time.monotonic()
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        started = time.monotonic()
        arm.stop()
        assert time.monotonic() - started < 0.5
        assert arm.get_encoder(2) == 2
        assert time.monotonic() - sent_at >= 1.0
