"""Answers that come late: never taken for the answer to another question."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec
from cobotwire.errors import UsageError
from cobotwire.session import Answered, Expired, HostSession, Late, Unasked
from cobotwire.session.policy import GRACE_SECONDS

ENCODER = bytes.fromhex("FE FE 04 3B 08 00 FA")
MINIMUM_OF_1 = bytes.fromhex("FE FE 05 4A 01 F9 F2 FA")
TEXT = b"ssid: one password: two"


@pytest.fixture
def session(codec: Codec) -> HostSession:
    return HostSession(codec)


def give_up(session: HostSession, name: str, *values: int) -> None:
    session.request(name, values, now=0.0, timeout=0.1)
    assert isinstance(session.wake(0.1)[-1], Expired)


def held(session: HostSession, name: str, *values: int) -> float | None:
    return session.hold_until(session.prepare(name, values))


def test_a_question_is_held_while_an_answer_like_its_own_is_owed(session: HostSession) -> None:
    give_up(session, "get_encoder", 1)
    # The reply does not say whose encoder it tells: no other joint may be asked either.
    for joint in (1, 2):
        assert held(session, "get_encoder", joint) == GRACE_SECONDS
        with pytest.raises(UsageError, match="earlier one may still come"):
            session.request("get_encoder", (joint,), now=GRACE_SECONDS - 0.01)
        assert not session.waiting
    assert held(session, "get_angles") is None
    assert held(session, "set_encoder", 1, 5) is None, "an order is never held"
    session.request("get_encoder", (2,), now=GRACE_SECONDS)
    assert session.waiting


def test_the_late_answer_lifts_the_hold(session: HostSession) -> None:
    give_up(session, "get_encoder", 1)
    assert [type(e) for e in session.receive(ENCODER, 0.15)] == [Late]
    assert held(session, "get_encoder", 2) is None
    session.request("get_encoder", (2,), now=0.16)
    assert [type(e) for e in session.receive(ENCODER, 0.17)] == [Answered]


def test_an_abandoned_question_is_owed_its_answer_too(session: HostSession) -> None:
    session.request("get_encoder", (1,), now=5.0)
    session.abandon()
    assert held(session, "get_encoder", 2) == 5.0 + GRACE_SECONDS


def test_echoed_arguments_tell_answers_apart(session: HostSession) -> None:
    give_up(session, "get_joint_min_angle", 1)
    assert held(session, "get_joint_min_angle", 1) == GRACE_SECONDS
    assert held(session, "get_joint_min_angle", 2) is None
    session.request("get_joint_min_angle", (2,), now=0.2)
    assert [type(e) for e in session.receive(MINIMUM_OF_1, 0.3)] == [Late]
    assert session.waiting
    assert held(session, "get_joint_min_angle", 1) is None, "it has come"


def test_an_answer_that_older_firmware_gives_without_its_echo_does_not(
    session: HostSession,
) -> None:
    give_up(session, "is_servo_enable", 3)
    assert held(session, "is_servo_enable", 4) == GRACE_SECONDS


def test_a_late_text_is_waited_out(session: HostSession) -> None:
    give_up(session, "get_ssid_pwd")
    session.receive(TEXT, 0.3)
    assert held(session, "get_ssid_pwd") == GRACE_SECONDS


def test_the_echo_of_a_question_does_not_settle_what_is_owed(session: HostSession) -> None:
    session.request("is_servo_enable", (1,), now=0.0)
    session.abandon()
    session.receive(bytes.fromhex("FE FE 03 50 01 FA"), 0.1)
    assert held(session, "is_servo_enable", 2) == GRACE_SECONDS


def test_an_illegal_answer_that_may_be_a_late_one_refuses_nobody(session: HostSession) -> None:
    give_up(session, "get_joint_min_angle", 1)
    session.request("get_joint_min_angle", (2,), now=0.2)
    [event] = session.receive(bytes.fromhex("FE FE 05 4A 09 F9 F2 FA"), 0.3)
    assert isinstance(event, Unasked)
    assert session.waiting
