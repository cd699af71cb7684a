"""Our client reads every reply of the 280 like pymycobot's MyCobot280, except where listed."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from cobotwire.codec import CodecName
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import ReplyTimeout
from cobotwire.protocol.table import Command
from pymycobot_280_replies import (
    ACKS,
    DIFFERENCES,
    OTHER_READINGS,
    REPLIES,
    OtherReading,
    arguments_for,
    bits,
    plain,
    read_by_pymycobot,
    read_by_us,
)
from pymycobot_280_requests import REQUESTS
from robots.arguments import end
from strategies import codec_of

# pymycobot reads the locale in a deprecated way, to print faults in Chinese.
pytestmark = pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")

REPLY_VARIANTS = [
    variant
    for variant in strategies.variants_of(TABLE)
    if variant.direction == "reply" and variant.variant.fields
]
RESULT_VARIANTS = [variant for variant in REPLY_VARIANTS if not variant.command.ack]
OLD_PINS = {"get_digital_input", "get_basic_input"}


def _id(variant: strategies.CommandVariant) -> str:
    return f"{variant.command.name}-{variant.variant.size}"


def _is_older_pin(variant: strategies.CommandVariant) -> bool:
    return variant.command.name in OLD_PINS and variant.variant.size == 1


@pytest.mark.parametrize("variant", [f for f in RESULT_VARIANTS if not _is_older_pin(f)], ids=_id)
@pytest.mark.parametrize("codec_name", ["reference", "native"])
@settings(max_examples=25)
@given(data=st.data())
def test_random_reply_is_read_alike_by_both_sides(
    variant: strategies.CommandVariant, codec_name: CodecName, data: st.DataObject
) -> None:
    values = data.draw(strategies.legal_values(variant.variant))
    _assert_read_alike(variant, codec_name, values)


@pytest.mark.parametrize("variant", [f for f in RESULT_VARIANTS if not _is_older_pin(f)], ids=_id)
@pytest.mark.parametrize("high", [False, True])
def test_reply_with_lowest_or_highest_values_is_read_alike_by_both_sides(
    variant: strategies.CommandVariant, high: bool, codec: Codec
) -> None:
    _assert_read_alike(
        variant, codec.name, tuple(end(field, high) for field in variant.variant.fields)
    )


def _assert_read_alike(
    variant: strategies.CommandVariant, codec_name: CodecName, values: tuple[Any, ...]
) -> None:
    name = variant.command.name
    frame = strategies.frame_of(codec_of("mycobot280", codec_name), variant, values)
    echoed = {f.name: v for f, v in zip(variant.variant.fields, values) if f.echo}
    arguments = arguments_for(variant.command, echoed)
    ours = read_by_us(codec_name, name, arguments, frame)
    _, to_theirs = DIFFERENCES.get(name, ("", lambda same: same))
    assert read_by_pymycobot(name, arguments, frame) == to_theirs(ours)


@pytest.mark.parametrize("name", DIFFERENCES)
def test_listed_difference_of_result_exists(name: str, codec: Codec) -> None:
    ruling, to_theirs = DIFFERENCES[name]
    variant = next(variant for variant in RESULT_VARIANTS if variant.command.name == name)
    rows = tuple(
        tuple(17.0 + i if n.scaled else 17 + i for i, n in enumerate(field.cases[0].numbers))
        for field in variant.variant.fields
    )
    frame = strategies.frame_of(codec_of("mycobot280", codec.name), variant, rows)
    ours = read_by_us(codec.name, name, (), frame)
    theirs = read_by_pymycobot(name, (), frame)
    assert theirs == to_theirs(ours) != ours
    assert ruling


@pytest.mark.parametrize("command", ACKS, ids=lambda command: command.name)
@pytest.mark.parametrize("word", [0, 1, 2, 255])
def test_acknowledgement_is_read_alike_by_both_sides(
    command: Command, word: int, codec: Codec
) -> None:
    codec = codec_of("mycobot280", codec.name)
    frame = codec.encode(command.name, "reply", (word,))
    theirs = read_by_pymycobot(command.name, REQUESTS[command.name][0], frame)
    ours = codec.decode("reply", frame, of=command.name).fields["done"]
    assert theirs == (1 if command.name == "set_basic_output" else ours)


@pytest.mark.parametrize("reading", OTHER_READINGS, ids=lambda r: f"{r.call}-{r.reply.hex()}")
def test_listed_reply_is_read_differently_with_the_listed_results(
    reading: OtherReading, codec: Codec
) -> None:
    def ours() -> Any:
        if TABLE.command(reading.call).ack:
            codec_280 = codec_of("mycobot280", codec.name)
            return codec_280.decode("reply", reading.reply, of=reading.call).fields
        return read_by_us(codec.name, reading.call, reading.arguments, reading.reply)

    def theirs() -> Any:
        return read_by_pymycobot(reading.call, reading.arguments, reading.reply)

    assert (_outcome(ours), _outcome(theirs)) == (reading.ours, reading.theirs)
    assert reading.ours != reading.theirs
    assert reading.ruling


def _outcome(action: Callable[[], Any]) -> Any:
    try:
        return action()
    except (ReplyTimeout, struct.error) as error:
        return type(error)


def test_six_servo_bytes_return_the_first_and_only_our_codec_keeps_the_rest(
    codec: Codec,
) -> None:
    frame = bytes.fromhex("FE FE 08 51 01 00 01 00 01 00 FA")
    assert read_by_us(codec.name, "is_all_servo_enable", (), frame) == 1
    assert read_by_pymycobot("is_all_servo_enable", (), frame) == 1
    fields = codec_of("mycobot280", codec.name).decode("reply", frame).fields
    assert plain(fields["further"]) == [0, 1, 0, 1, 0]


def test_servo_status_is_printed_by_pymycobot_only(
    capsys: pytest.CaptureFixture[str], codec: Codec
) -> None:
    frame = bytes.fromhex("FE FE 08 E4 00 05 00 00 00 80 FA")
    assert read_by_us(codec.name, "get_servo_status", (), frame) == [0, 5, 0, 0, 0, 128]
    assert capsys.readouterr().out == ""
    theirs = read_by_pymycobot("get_servo_status", (), frame)
    assert theirs == [0, [0, 2], 0, 0, 0, [7]] == [bits(byte) for byte in frame[4:-1]]
    assert "Joint2" in capsys.readouterr().out


def test_account_of_single_words_is_read_alike_by_both_sides(codec: Codec) -> None:
    text = b"ssid: MyCobotWiFi2.4G password: mycobot123"
    ours = read_by_us(codec.name, "get_ssid_pwd", (), text)
    assert ours == list(read_by_pymycobot("get_ssid_pwd", (), text))


def test_every_command_with_a_reply_is_compared() -> None:
    compared = {variant.command.name for variant in RESULT_VARIANTS} | {
        command.name for command in ACKS
    }
    assert compared == {command.name for command in TABLE.commands if command.reply}
    others = [command for command in TABLE.commands if not command.reply]
    assert [command.name for command in others] == ["jog_stop", "get_ssid_pwd", "set_ssid_pwd"]
    assert len(REPLIES) + len(ACKS) == 106
    assert set(DIFFERENCES) < {command.name for command in REPLIES}
