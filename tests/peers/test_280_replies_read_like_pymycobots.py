"""Every reply of the 280 reads like in pymycobot's MyCobot280, but for the listed calls."""

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
from cobotwire.errors import ReplyTimeout
from cobotwire.table import Command
from pymycobot_280_replies import (
    ACKS,
    DIFFERENCES,
    OTHER_READINGS,
    REPLIES,
    OtherReading,
    bits,
    heard_by_pymycobot,
    heard_by_us,
    plain,
    question,
)
from pymycobot_280_requests import REQUESTS, end
from strategies import codec_of

# It asks for the locale in a way that Python 3.11 deprecates, to print faults in Chinese.
pytestmark = pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")

FORMS = [
    form for form in strategies.forms_of(TABLE) if form.direction == "reply" and form.layout.fields
]
ANSWERS = [form for form in FORMS if not form.command.ack]
OLD_PINS = {"get_digital_input", "get_basic_input"}


def _id(form: strategies.Form) -> str:
    return f"{form.command.name}-{form.layout.size}"


def _is_older_pin(form: strategies.Form) -> bool:
    return form.command.name in OLD_PINS and form.layout.size == 1


@pytest.mark.parametrize("form", [f for f in ANSWERS if not _is_older_pin(f)], ids=_id)
@pytest.mark.parametrize("codec_name", ["reference", "native"])
@settings(max_examples=25)
@given(data=st.data())
def test_a_reply_reads_alike_on_both_sides(
    form: strategies.Form, codec_name: CodecName, data: st.DataObject
) -> None:
    values = data.draw(strategies.legal_values(form.layout))
    _alike(form, codec_name, values)


@pytest.mark.parametrize("form", [f for f in ANSWERS if not _is_older_pin(f)], ids=_id)
@pytest.mark.parametrize("high", [False, True])
def test_the_lowest_and_the_highest_reply_read_alike(
    form: strategies.Form, high: bool, codec: Codec
) -> None:
    _alike(form, codec.name, tuple(end(field, high) for field in form.layout.fields))


def _alike(form: strategies.Form, codec_name: CodecName, values: tuple[Any, ...]) -> None:
    name = form.command.name
    frame = strategies.frame_of(codec_of("mycobot280", codec_name), form, values)
    echoed = {f.name: v for f, v in zip(form.layout.fields, values) if f.echo}
    arguments = question(form.command, echoed)
    ours = heard_by_us(codec_name, name, arguments, frame)
    _, other_words = DIFFERENCES.get(name, ("", lambda same: same))
    assert heard_by_pymycobot(name, arguments, frame) == other_words(ours)


@pytest.mark.parametrize("name", DIFFERENCES)
def test_a_listed_difference_is_one(name: str, codec: Codec) -> None:
    ruling, other_words = DIFFERENCES[name]
    form = next(form for form in ANSWERS if form.command.name == name)
    rows = tuple(
        tuple(17.0 + i if n.scaled else 17 + i for i, n in enumerate(field.cases[0].numbers))
        for field in form.layout.fields
    )
    frame = strategies.frame_of(codec_of("mycobot280", codec.name), form, rows)
    ours = heard_by_us(codec.name, name, (), frame)
    theirs = heard_by_pymycobot(name, (), frame)
    assert theirs == other_words(ours) != ours
    assert ruling


@pytest.mark.parametrize("command", ACKS, ids=lambda command: command.name)
@pytest.mark.parametrize("word", [0, 1, 2, 255])
def test_an_acknowledgement_reads_alike(command: Command, word: int, codec: Codec) -> None:
    codec = codec_of("mycobot280", codec.name)
    frame = codec.encode(command.name, "reply", (word,))
    theirs = heard_by_pymycobot(command.name, REQUESTS[command.name][0], frame)
    ours = codec.decode("reply", frame, of=command.name).fields["done"]
    assert theirs == (1 if command.name == "set_basic_output" else ours)


@pytest.mark.parametrize("reading", OTHER_READINGS, ids=lambda r: f"{r.call}-{r.reply.hex()}")
def test_a_reply_that_is_listed_is_read_by_both_sides_as_the_list_says(
    reading: OtherReading, codec: Codec
) -> None:
    def ours() -> Any:
        if TABLE.command(reading.call).ack:
            codec_280 = codec_of("mycobot280", codec.name)
            return codec_280.decode("reply", reading.reply, of=reading.call).fields
        return heard_by_us(codec.name, reading.call, reading.arguments, reading.reply)

    def theirs() -> Any:
        return heard_by_pymycobot(reading.call, reading.arguments, reading.reply)

    assert (_outcome(ours), _outcome(theirs)) == (reading.ours, reading.theirs)
    assert reading.ours != reading.theirs
    assert reading.ruling


def _outcome(action: Callable[[], Any]) -> Any:
    try:
        return action()
    except (ReplyTimeout, struct.error) as error:
        return type(error)


def test_of_six_bytes_of_servos_the_first_counts_and_only_our_codec_keeps_the_rest(
    codec: Codec,
) -> None:
    frame = bytes.fromhex("FE FE 08 51 01 00 01 00 01 00 FA")
    assert heard_by_us(codec.name, "is_all_servo_enable", (), frame) == 1
    assert heard_by_pymycobot("is_all_servo_enable", (), frame) == 1
    fields = codec_of("mycobot280", codec.name).decode("reply", frame).fields
    assert plain(fields["further"]) == [0, 1, 0, 1, 0]


def test_only_pymycobot_prints_what_it_reads_from_the_status(
    capsys: pytest.CaptureFixture[str], codec: Codec
) -> None:
    frame = bytes.fromhex("FE FE 08 E4 00 05 00 00 00 80 FA")
    assert heard_by_us(codec.name, "get_servo_status", (), frame) == [0, 5, 0, 0, 0, 128]
    assert capsys.readouterr().out == ""
    theirs = heard_by_pymycobot("get_servo_status", (), frame)
    assert theirs == [0, [0, 2], 0, 0, 0, [7]] == [bits(byte) for byte in frame[4:-1]]
    assert "Joint2" in capsys.readouterr().out


def test_an_account_of_single_words_reads_alike(codec: Codec) -> None:
    text = b"ssid: MyCobotWiFi2.4G password: mycobot123"
    ours = heard_by_us(codec.name, "get_ssid_pwd", (), text)
    assert ours == list(heard_by_pymycobot("get_ssid_pwd", (), text))


def test_every_call_with_a_reply_is_compared() -> None:
    compared = {form.command.name for form in ANSWERS} | {command.name for command in ACKS}
    assert compared == {command.name for command in TABLE.commands if command.reply}
    others = [command for command in TABLE.commands if not command.reply]
    assert [command.name for command in others] == ["get_ssid_pwd", "set_ssid_pwd"]
    assert len(REPLIES) + len(ACKS) == 106
    assert set(DIFFERENCES) < {command.name for command in REPLIES}
