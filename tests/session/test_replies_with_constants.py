"""Replies of one id are distinguished only by a constant, as those of the grippers of the 320.

``test_rust_exchange.py`` compares these rules with those in Rust, on random requests and replies.
"""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions import load
from cobotwire.session import LateReply, ReplyMatched, ReplyRejected, UnexpectedFrame
from session.one_caller import OneCaller

# A reply repeats the number of the gripper, and has the number of its register: 0E or 1C.
STATUS, TORQUE = "get_pro_gripper_status", "get_pro_gripper_torque"
READ_STATUS, READ_TORQUE = (14, 14), (14, 28)
STATUS_1 = bytes.fromhex("FE FE 07 E9 0E 00 0E 00 01 FA")
TORQUE_50 = bytes.fromhex("FE FE 07 E9 0E 00 1C 00 32 FA")
ILLEGAL_STATUS = bytes.fromhex("FE FE 07 E9 0E 00 0E 00 07 FA")
ILLEGAL_TORQUE = bytes.fromhex("FE FE 07 E9 0E 00 1C FF FF FA")


@pytest.fixture
def session(codec: Codec, repeated_in_rust: None) -> OneCaller:
    return OneCaller(codecs.load(load("mycobot320").TABLE, codec.name))


def kinds(events: list[Any]) -> list[type]:
    return [type(event) for event in events]


@pytest.mark.parametrize("foreign", [STATUS_1, ILLEGAL_STATUS])
def test_reply_with_the_constant_of_another_command_does_not_end_the_request(
    session: OneCaller, foreign: bytes
) -> None:
    session.request(TORQUE, READ_TORQUE, now=0.0)
    assert kinds(session.receive(foreign, 0.01)) == [UnexpectedFrame]
    assert session.waiting
    [matched] = session.receive(TORQUE_50, 0.02)
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == {"gripper_id": 14, "register": 28, "torque": 50}


def test_illegal_value_after_the_own_constant_ends_the_request(session: OneCaller) -> None:
    session.request(TORQUE, READ_TORQUE, now=0.0)
    assert kinds(session.receive(ILLEGAL_TORQUE, 0.01)) == [ReplyRejected]


def test_illegal_value_ends_no_request_while_another_reply_is_outstanding(
    session: OneCaller,
) -> None:
    session.request(TORQUE, (15, 28), now=0.0, timeout=0.1)
    session.wake(0.1)
    assert session.request(TORQUE, READ_TORQUE, now=0.1)
    assert kinds(session.receive(ILLEGAL_TORQUE, 0.15)) == [UnexpectedFrame]
    assert session.waiting


def test_outstanding_reply_does_not_hold_a_request_that_its_constant_excludes(
    session: OneCaller,
) -> None:
    session.request(TORQUE, READ_TORQUE, now=0.0, timeout=0.1)
    session.wake(0.1)
    assert session.request(TORQUE, READ_TORQUE, now=0.2) == b"", "it could take the late reply"
    session.give_up()
    assert session.request(STATUS, READ_STATUS, now=0.2)
    assert kinds(session.receive(TORQUE_50, 0.3)) == [LateReply]
    assert session.waiting
    assert kinds(session.receive(STATUS_1, 0.4)) == [ReplyMatched]
