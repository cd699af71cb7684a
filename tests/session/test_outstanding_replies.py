"""A late reply never becomes the reply to another request."""

from __future__ import annotations

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions import mycobot280
from cobotwire.session import (
    Exchange,
    LateReply,
    ReplyMatched,
    RequestExpired,
    RetryPolicy,
    UnexpectedFrame,
)
from cobotwire.session.pending import GRACE_SECONDS
from cobotwire.session.request import RequestEncoder
from session.one_caller import OneCaller, submit

ENCODER = bytes.fromhex("FE FE 04 3B 08 00 FA")
MINIMUM_OF_1 = bytes.fromhex("FE FE 05 4A 01 F9 F2 FA")
TEXT = b"ssid: one password: two"


@pytest.fixture
def session(codec: Codec) -> OneCaller:
    return OneCaller(codec)


def give_up(session: OneCaller, name: str, *values: int) -> None:
    session.request(name, values, now=0.0, timeout=0.1)
    assert isinstance(session.wake(0.1)[-1], RequestExpired)


def test_request_is_held_while_a_reply_that_looks_like_its_own_is_outstanding(
    session: OneCaller,
) -> None:
    give_up(session, "get_encoder", 1)
    # The reply does not name its encoder, so a query for another joint is held, too.
    for joint in (1, 2):
        assert session.free_at("get_encoder", joint, now=0.2) == GRACE_SECONDS
        assert session.request("get_encoder", (joint,), now=GRACE_SECONDS - 0.01) == b""
        session.give_up()
    assert session.free_at("get_angles", now=0.2) == 0.2
    assert session.request("set_encoder", (1, 5), now=0.2), "a one-way request is never held"
    assert session.request("get_encoder", (2,), now=GRACE_SECONDS)


def test_request_is_held_while_a_reply_to_its_other_name_is_outstanding() -> None:
    session = OneCaller(codecs.load(mycobot280.TABLE))
    give_up(session, "get_angles")
    assert session.free_at("get_radians", now=0.2) == GRACE_SECONDS


def test_late_reply_does_not_end_the_hold_since_it_may_come_twice(session: OneCaller) -> None:
    give_up(session, "get_encoder", 1)
    for now in (0.15, 0.16):
        assert [type(e) for e in session.receive(ENCODER, now)] == [LateReply]
    assert session.free_at("get_encoder", 2, now=0.17) == GRACE_SECONDS
    session.request("get_encoder", (2,), now=GRACE_SECONDS)
    assert [type(e) for e in session.receive(ENCODER, 1.01)] == [ReplyMatched]


def test_copy_of_a_late_reply_does_not_count_for_another_attempt(codec: Codec) -> None:
    exchange, encoder = Exchange(codec), RequestEncoder(codec)
    policy = RetryPolicy(attempts=2)
    first = submit(exchange, encoder.encode("get_encoder", (1,)), 0.0, policy, 0.4)
    for now in (0.0, 0.2):
        assert exchange.outgoing(now, drained=True)
    assert [type(e) for e in exchange.receive(ENCODER, 0.9)] == [ReplyMatched]
    assert first.done
    # The line doubles replies: this is a copy, and the reply to the second attempt is to come.
    assert [type(e) for e in exchange.receive(ENCODER, 0.91)] == [LateReply]
    submit(exchange, encoder.encode("get_encoder", (2,)), 0.92, policy, 0.4)
    assert exchange.outgoing(0.92, drained=True) == b""
    assert [type(e) for e in exchange.receive(ENCODER, 1.1)] == [LateReply]
    assert exchange.outgoing(0.2 + GRACE_SECONDS, drained=True)


def test_repeated_arguments_distinguish_replies(session: OneCaller) -> None:
    give_up(session, "get_joint_min_angle", 1)
    assert session.free_at("get_joint_min_angle", 1, now=0.2) == GRACE_SECONDS
    assert session.free_at("get_joint_min_angle", 2, now=0.2) == 0.2
    session.request("get_joint_min_angle", (2,), now=0.2)
    assert [type(e) for e in session.receive(MINIMUM_OF_1, 0.3)] == [LateReply]
    assert session.waiting
    session.give_up()
    assert session.free_at("get_joint_min_angle", 1, now=0.3) == GRACE_SECONDS
    assert session.free_at("get_joint_min_angle", 2, now=0.3) == 0.2 + GRACE_SECONDS


def test_replies_that_may_not_repeat_their_argument_are_not_distinguished(
    session: OneCaller,
) -> None:
    give_up(session, "is_servo_enable", 3)
    assert session.free_at("is_servo_enable", 4, now=0.2) == GRACE_SECONDS


def test_late_text_does_not_end_the_hold(session: OneCaller) -> None:
    give_up(session, "get_ssid_pwd")
    session.receive(TEXT, 0.3)
    assert session.free_at("get_ssid_pwd", now=0.4) == GRACE_SECONDS


def test_echo_of_a_request_does_not_end_the_hold(session: OneCaller) -> None:
    session.request("is_servo_enable", (1,), now=0.0)
    session.give_up()
    session.receive(bytes.fromhex("FE FE 03 50 01 FA"), 0.1)
    assert session.free_at("is_servo_enable", 2, now=0.2) == GRACE_SECONDS


def test_illegal_frame_that_may_be_a_late_reply_ends_no_request(session: OneCaller) -> None:
    give_up(session, "get_joint_min_angle", 1)
    session.request("get_joint_min_angle", (2,), now=0.2)
    [event] = session.receive(bytes.fromhex("FE FE 05 4A 09 F9 F2 FA"), 0.3)
    assert isinstance(event, UnexpectedFrame)
    assert session.waiting


@pytest.mark.parametrize("ended", [False, True])
def test_grace_begins_when_a_blocked_write_has_ended(codec: Codec, ended: bool) -> None:
    exchange, encoder = Exchange(codec), RequestEncoder(codec)
    pending = submit(exchange, encoder.encode("get_encoder", (1,)), 0.0, RetryPolicy(1), 0.4)
    assert exchange.outgoing(0.0, drained=True)
    if ended:
        exchange.give_up(pending)
    exchange.written(pending, 0.9)
    exchange.give_up(pending)
    submit(exchange, encoder.encode("get_encoder", (2,)), 1.0, RetryPolicy(1), 0.4)
    assert exchange.outgoing(0.89 + GRACE_SECONDS, drained=True) == b""
    assert exchange.outgoing(0.91 + GRACE_SECONDS, drained=True)
