"""For every command that pymycobot shares with this edition, the request is the same bytes."""

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
from pymycobot_classes import CLASSES, our_client, without_port, written
from pymycobot_difference import read_by, said_by, said_by_us
from pymycobot_differences import DIFFERENCES, never_equal
from pymycobot_requests import REQUESTS, can_say, requests_of
from pymycobot_strategies import BY_NAME

# The commands whose scale is disputed, and which pymycobot says in steps ten times as large.
TEN_TIMES = {"set_joint_min", "set_joint_max", "set_tool_reference", "set_world_reference"}

SHARED = [
    (command.name, peer)
    for command in TABLE.commands
    for peer, kind in CLASSES.items()
    if hasattr(kind, command.name)
]
EQUAL = [pair for pair in SHARED if not never_equal(*pair)]
SCALED = [(command, peer) for command, peer in EQUAL if command in BY_NAME]


@pytest.mark.parametrize(("command", "peer"), EQUAL)
def test_a_request_is_the_same_bytes_as_pymycobots(command: str, peer: str, codec: Codec) -> None:
    theirs = without_port(peer)
    for arguments in requests_of(command, peer):
        ours = written(our_client(codec.name), command, arguments)
        assert ours == written(theirs, command, arguments)


@pytest.mark.parametrize("key", DIFFERENCES, ids=" - ".join)
def test_a_listed_difference_is_one_and_becomes_what_the_list_says(
    key: tuple[str, str, str], codec: Codec
) -> None:
    command, peer, _ = key
    difference = DIFFERENCES[key]
    theirs = said_by(peer, difference)
    assert said_by_us(our_client(codec.name), command, difference) != theirs
    assert read_by(codec, theirs) == difference.becomes
    assert difference.ruling


def test_every_command_is_compared_with_at_least_one_class() -> None:
    assert {command for command, _ in SHARED} == {command.name for command in TABLE.commands}
    assert len(REQUESTS) == len(TABLE.commands) == 64
    assert all(
        len(REQUESTS[command.name]) > 1 for command in TABLE.commands if command.request[0].fields
    )


def test_five_commands_are_equal_in_no_class() -> None:
    equal = {command for command, _ in EQUAL}
    assert set(REQUESTS) - equal == {"set_encoder", *TEN_TIMES}


@pytest.mark.parametrize(("command", "peer"), [pair for pair in SHARED if pair[0] in TEN_TIMES])
def test_in_a_disputed_scale_its_request_is_ours_for_a_tenth(
    command: str, peer: str, codec: Codec
) -> None:
    for arguments in requests_of(command, peer):
        theirs = written(without_port(peer), command, arguments)
        assert written(our_client(codec.name), command, _tenth(arguments)) == theirs


@pytest.mark.parametrize("codec_name", ["reference", "native"])
@given(data=st.data())
def test_whatever_number_survives_truncation_becomes_the_same_bytes(
    data: st.DataObject, codec_name: CodecName
) -> None:
    command, peer = data.draw(st.sampled_from(SCALED))
    arguments = data.draw(BY_NAME[command].filter(lambda given: can_say(peer, command, given)))
    ours = written(our_client(codec_name), command, arguments)
    assert ours == written(without_port(peer), command, arguments)


def test_of_36001_angles_pymycobot_sends_2290_a_step_too_small(codec: Codec) -> None:
    ours, theirs = our_client(codec.name), without_port("MyCobot")
    cut = 0
    for step in range(-18000, 18001):
        # An increment, because it has no limits that would leave some angles out.
        wish = (1, step / 100, 50)
        exact = written(ours, "jog_increment", wish)
        sent = written(theirs, "jog_increment", wish)
        assert exact[5:7] == step.to_bytes(2, "big", signed=True)
        if sent != exact:
            toward_zero = step - 1 if step > 0 else step + 1
            assert sent[5:7] == toward_zero.to_bytes(2, "big", signed=True)
            cut += 1
    assert cut == 2290  # 6.4 percent of the hundredths of a degree in one turn
    assert written(theirs, "jog_increment", (1, 0.29, 50))[5:7] == b"\x00\x1c"
    assert written(ours, "jog_increment", (1, 0.29, 50))[5:7] == b"\x00\x1d"


def test_a_recorded_request_is_what_goes_over_a_real_port(pty_ends: tuple[int, str]) -> None:
    far_end, port = pty_ends
    # The palletizer's constructor alone does not sleep, and its setters wait for nothing.
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
    """One end of a pty to read from, and the name of the other."""
    master, slave = os.openpty()
    tty.setraw(slave)
    yield master, os.ttyname(slave)
    os.close(master)
    os.close(slave)


def _tenth(arguments: tuple[Any, ...]) -> tuple[Any, ...]:
    """The same request for lengths, or for a joint's limit, of a tenth."""
    if isinstance(arguments[0], int):
        return (arguments[0], arguments[1] / 10)
    x, y, z, *rotation = arguments[0]
    return ([x / 10, y / 10, z / 10, *rotation],)
