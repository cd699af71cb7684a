"""Lines that echo our own bytes."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Noise
from cobotwire.session import (
    EchoReceived,
    ReplyMatched,
    RequestExpired,
    UnexpectedFrame,
)
from session.one_caller import OneCaller

# Queries whether servo 1 is powered; from older firmware the same bytes report that it is.
ENABLED = bytes.fromhex("FE FE 03 50 01 FA")
DISABLED = bytes.fromhex("FE FE 04 50 01 00 FA")


@pytest.fixture
def session(codec: Codec) -> OneCaller:
    return OneCaller(codec)


def test_other_reply_shows_that_the_copy_was_an_echo(session: OneCaller) -> None:
    session.request("is_servo_enable", (1,), now=0.0)
    [echo] = session.receive(ENABLED, 0.01)
    assert isinstance(echo, EchoReceived)
    [matched] = session.receive(DISABLED, 0.02)
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == {"joint": 1, "enabled": False}


def test_second_copy_is_the_reply(session: OneCaller) -> None:
    session.request("is_servo_enable", (1,), now=0.0)
    [echo, matched] = session.receive(ENABLED + ENABLED, 0.01)
    assert isinstance(echo, EchoReceived)
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == {"enabled": True}


def test_copy_counts_at_the_deadline_on_a_line_that_never_echoed(
    session: OneCaller,
) -> None:
    session.request("is_servo_enable", (1,), now=0.0, timeout=0.2)
    session.receive(ENABLED, 0.01)
    assert session.wake(0.19) == []
    [matched] = session.wake(0.2)
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == {"enabled": True}


@pytest.mark.parametrize("chunk", [1, 3, 5])
def test_copy_that_cannot_be_a_reply_proves_that_the_line_echoes(
    session: OneCaller, chunk: int
) -> None:
    sent = session.request("power_on", (), now=0.0)
    for start in range(0, len(sent), chunk):
        session.receive(sent[start : start + chunk], 0.01)
    session.request("is_servo_enable", (1,), now=1.0, timeout=0.2)
    session.receive(ENABLED, 1.01)
    assert [type(event) for event in session.wake(1.2)] == [RequestExpired]


def test_copy_of_request_with_an_illegal_value_for_a_reply_is_an_echo(
    session: OneCaller,
) -> None:
    sent = session.request("is_servo_enable", (2,), now=0.0)
    assert [type(event) for event in session.receive(sent, 0.01)] == [EchoReceived]
    [matched] = session.receive(bytes.fromhex("FE FE 04 50 02 01 FA"), 0.02)
    assert isinstance(matched, ReplyMatched)
    session.request("is_servo_enable", (1,), now=1.0, timeout=0.2)
    session.receive(ENABLED, 1.01)
    assert [type(event) for event in session.wake(1.2)] == [RequestExpired]


def test_bytes_from_before_the_request_are_not_its_copy(session: OneCaller) -> None:
    session.receive(bytes.fromhex("FE FE 02 10 FA"), 0.0)
    assert [type(event) for event in session.receive(ENABLED, 0.1)] == [UnexpectedFrame]
    session.request("power_on", (), now=0.2)
    session.request("is_servo_enable", (1,), now=0.3, timeout=0.2)
    session.receive(ENABLED, 0.4)
    assert [type(event) for event in session.wake(0.5)] == [ReplyMatched]


def test_parts_of_the_request_around_a_frame_are_not_its_copy(session: OneCaller) -> None:
    sent = session.request("power_on", (), now=0.0)
    session.receive(sent[:3] + DISABLED + sent[3:], 0.01)
    session.request("is_servo_enable", (1,), now=1.0, timeout=0.2)
    session.receive(ENABLED, 1.01)
    assert [type(event) for event in session.wake(1.2)] == [ReplyMatched]


def test_echo_that_is_noise_is_reported_as_noise(session: OneCaller) -> None:
    sent = session.request("get_angles", (), now=0.0)
    events = session.receive(sent, 0.01)
    assert b"".join(event.data for event in events if isinstance(event, Noise)) == sent
