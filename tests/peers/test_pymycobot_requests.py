"""pymycobot's requests equal ours, for every command that it shares with edition mycobot."""

from __future__ import annotations

import os
import tty
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.codec import CodecName
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from pymycobot_classes import CLASSES, recording_client, without_port, written
from pymycobot_difference import decoded_by, sent_by, sent_by_us
from pymycobot_differences import DIFFERENCES, never_equal
from pymycobot_requests import REQUESTS, accepts, requests_of
from pymycobot_strategies import BY_NAME

# Commands with a disputed scale: pymycobot's steps are ten times as large.
TEN_TIMES = {"set_joint_min", "set_joint_max", "set_tool_reference", "set_world_reference"}

SHARED = [
    (command.name, peer)
    for command in TABLE.commands
    for peer in ("MyCobot", "MyCobot280", "MyPalletizer260")
    if hasattr(CLASSES[peer], command.name)
]
EQUAL = [pair for pair in SHARED if not never_equal(*pair)]
SCALED = [(command, peer) for command, peer in EQUAL if command in BY_NAME]


@pytest.mark.parametrize(("command", "peer"), EQUAL)
def test_request_equals_pymycobots_bytes(command: str, peer: str, codec: Codec) -> None:
    theirs = without_port(peer)
    for arguments in requests_of(command, peer):
        ours = written(recording_client(codec.name), command, arguments)
        assert ours == written(theirs, command, arguments)


@pytest.mark.parametrize("key", DIFFERENCES, ids=" - ".join)
def test_listed_difference_exists_and_is_decoded_as_listed(
    key: tuple[str, str, str], codec: Codec
) -> None:
    command, peer, _ = key
    difference = DIFFERENCES[key]
    theirs = sent_by(peer, difference)
    assert sent_by_us(recording_client(codec.name), command, difference) != theirs
    assert decoded_by(codec, theirs) == difference.becomes
    assert difference.ruling


def test_every_command_is_compared_with_at_least_one_class() -> None:
    assert {command for command, _ in SHARED} == {command.name for command in TABLE.commands}
    assert len(REQUESTS) == len(TABLE.commands) == 64
    assert all(
        len(REQUESTS[command.name]) > 1 for command in TABLE.commands if command.request[0].fields
    )


def test_exactly_five_commands_are_equal_in_no_class() -> None:
    equal = {command for command, _ in EQUAL}
    assert set(REQUESTS) - equal == {"set_encoder", *TEN_TIMES}


@pytest.mark.parametrize(("command", "peer"), [pair for pair in SHARED if pair[0] in TEN_TIMES])
def test_request_in_disputed_scale_equals_ours_for_a_tenth(
    command: str, peer: str, codec: Codec
) -> None:
    for arguments in requests_of(command, peer):
        theirs = written(without_port(peer), command, arguments)
        assert written(recording_client(codec.name), command, _tenth(arguments)) == theirs


@pytest.mark.parametrize("codec_name", ["reference", "native"])
@given(data=st.data())
def test_number_that_truncation_does_not_change_is_encoded_equally_by_both_sides(
    data: st.DataObject, codec_name: CodecName
) -> None:
    command, peer = data.draw(st.sampled_from(SCALED))
    arguments = data.draw(BY_NAME[command].filter(lambda given: accepts(peer, command, given)))
    ours = written(recording_client(codec_name), command, arguments)
    assert ours == written(without_port(peer), command, arguments)


def test_pymycobot_sends_2290_of_36001_angles_a_step_too_small(codec: Codec) -> None:
    theirs = without_port("MyCobot")
    truncated = 0
    for step in range(-18000, 18001):
        # An increment has no limits, so every angle can be sent.
        arguments = (1, step / 100, 50)
        exact = codec.encode("jog_increment", "request", arguments)
        sent = written(theirs, "jog_increment", arguments)
        assert exact[5:7] == step.to_bytes(2, "big", signed=True)
        if sent != exact:
            toward_zero = step - 1 if step > 0 else step + 1
            assert sent[5:7] == toward_zero.to_bytes(2, "big", signed=True)
            truncated += 1
    assert truncated == 2290  # 6.4 percent of the hundredths of a degree in one turn
    assert written(theirs, "jog_increment", (1, 0.29, 50))[5:7] == b"\x00\x1c"
    ours = recording_client(codec.name)
    assert written(ours, "jog_increment", (1, 0.29, 50))[5:7] == b"\x00\x1d"


def test_recorded_request_equals_the_bytes_on_a_real_port(pty_ends: tuple[int, str]) -> None:
    far_end, port = pty_ends
    # Only the palletizer's constructor does not sleep, and its setters do not wait.
    peer = CLASSES["MyPalletizer260"](port)
    try:
        for arguments in REQUESTS["set_color"]:
            recorded = written(without_port("MyPalletizer260"), "set_color", arguments)
            peer.set_color(*arguments)
            assert os.read(far_end, 64) == recorded
    finally:
        peer.close()


@pytest.fixture
def pty_ends() -> Iterator[tuple[int, str]]:
    """Open a pty: one end to read from, and the name of the other."""
    master, slave = os.openpty()
    tty.setraw(slave)
    yield master, os.ttyname(slave)
    os.close(master)
    os.close(slave)


def _tenth(arguments: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the arguments with lengths, or with the joint's limit, divided by ten."""
    if isinstance(arguments[0], int):
        return (arguments[0], arguments[1] / 10)
    x, y, z, *rotation = arguments[0]
    return ([x / 10, y / 10, z / 10, *rotation],)
