"""Lines that send our own bytes back."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Noise
from cobotwire.session import Answered, Echoed, Expired, HostSession, Unasked

# Asks whether servo 1 is powered; and, from an older arm, answers that it is.
ENABLED = bytes.fromhex("FE FE 03 50 01 FA")
DISABLED = bytes.fromhex("FE FE 04 50 01 00 FA")


@pytest.fixture
def session(codec: Codec) -> HostSession:
    return HostSession(codec)


def test_another_answer_shows_that_the_first_was_the_echo(session: HostSession) -> None:
    session.request("is_servo_enable", (1,), now=0.0)
    [echo] = session.receive(ENABLED, 0.01)
    assert isinstance(echo, Echoed)
    [answer] = session.receive(DISABLED, 0.02)
    assert isinstance(answer, Answered)
    assert answer.fields == {"joint": 1, "enabled": False}


def test_a_second_copy_is_the_answer(session: HostSession) -> None:
    session.request("is_servo_enable", (1,), now=0.0)
    [echo, answer] = session.receive(ENABLED + ENABLED, 0.01)
    assert isinstance(echo, Echoed)
    assert isinstance(answer, Answered)
    assert answer.fields == {"enabled": True}


def test_on_a_line_that_was_never_seen_to_echo_the_copy_counts_at_the_deadline(
    session: HostSession,
) -> None:
    session.request("is_servo_enable", (1,), now=0.0, timeout=0.2)
    session.receive(ENABLED, 0.01)
    assert session.wake(0.19) == []
    [answer] = session.wake(0.2)
    assert isinstance(answer, Answered)
    assert answer.fields == {"enabled": True}


@pytest.mark.parametrize("chunk", [1, 3, 5])
def test_a_copy_that_can_be_no_reply_proves_that_the_line_echoes(
    session: HostSession, chunk: int
) -> None:
    sent = session.request("power_on", (), now=0.0)
    for start in range(0, len(sent), chunk):
        session.receive(sent[start : start + chunk], 0.01)
    session.request("is_servo_enable", (1,), now=1.0, timeout=0.2)
    session.receive(ENABLED, 1.01)
    assert [type(event) for event in session.wake(1.2)] == [Expired]


def test_a_copy_with_a_value_that_no_reply_holds_is_an_echo_and_no_error(
    session: HostSession,
) -> None:
    sent = session.request("is_servo_enable", (2,), now=0.0)
    assert [type(event) for event in session.receive(sent, 0.01)] == [Echoed]
    [answer] = session.receive(bytes.fromhex("FE FE 04 50 02 01 FA"), 0.02)
    assert isinstance(answer, Answered)
    session.request("is_servo_enable", (1,), now=1.0, timeout=0.2)
    session.receive(ENABLED, 1.01)
    assert [type(event) for event in session.wake(1.2)] == [Expired]


def test_what_came_before_the_request_is_no_copy_of_it(session: HostSession) -> None:
    session.receive(bytes.fromhex("FE FE 02 10 FA"), 0.0)
    assert [type(event) for event in session.receive(ENABLED, 0.1)] == [Unasked]
    session.request("power_on", (), now=0.2)
    session.request("is_servo_enable", (1,), now=0.3, timeout=0.2)
    session.receive(ENABLED, 0.4)
    assert [type(event) for event in session.wake(0.5)] == [Answered]


def test_an_echo_that_is_noise_is_told_as_noise(session: HostSession) -> None:
    sent = session.request("get_angles", (), now=0.0)
    events = session.receive(sent, 0.01)
    assert b"".join(event.data for event in events if isinstance(event, Noise)) == sent
