"""Every reply of the 280 reads like in pymycobot's MyCobot280, but for the listed calls."""

from __future__ import annotations

import struct
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
    OF_ANOTHER,
    ONE_BYTE,
    REPLIES,
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
    # It says 1 for whatever answers set_basic_output; we say what came.
    assert theirs == (1 if command.name == "set_basic_output" else ours)


@pytest.mark.parametrize("command", ACKS, ids=lambda command: command.name)
def test_a_bare_acknowledgement_is_one_here_and_a_failure_to_pymycobot(
    command: Command, codec: Codec
) -> None:
    codec = codec_of("mycobot280", codec.name)
    frame = codec.encode(command.name, "reply", ())
    assert codec.decode("reply", frame, of=command.name).fields == {}
    assert heard_by_pymycobot(command.name, REQUESTS[command.name][0], frame) == -1


@pytest.mark.parametrize(
    ("name", "pin", "frame"),
    [
        ("get_digital_input", 23, "FE FE 03 62 01 FA"),
        ("get_basic_input", 5, "FE FE 03 A1 01 FA"),
    ],
)
def test_a_level_without_its_pin_raises_out_of_pymycobot(
    name: str, pin: int, frame: str, codec: Codec
) -> None:
    assert heard_by_us(codec.name, name, (pin,), bytes.fromhex(frame)) == 1
    with pytest.raises(struct.error):
        heard_by_pymycobot(name, (pin,), bytes.fromhex(frame))
    assert ONE_BYTE


@pytest.mark.parametrize(
    ("name", "frame", "theirs"),
    [
        ("get_joint_min_angle", "FE FE 05 4A 02 06 0E FA", 155.0),
        ("get_joint_max_angle", "FE FE 05 4B 02 06 0E FA", 155.0),
        ("is_servo_enable", "FE FE 04 50 02 01 FA", 1),
    ],
)
def test_the_reply_of_another_joint_is_taken_by_pymycobot_alone(
    name: str, frame: str, theirs: float, codec: Codec
) -> None:
    assert heard_by_pymycobot(name, (1,), bytes.fromhex(frame)) == theirs
    with pytest.raises(ReplyTimeout):
        heard_by_us(codec.name, name, (1,), bytes.fromhex(frame))
    assert OF_ANOTHER


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


@pytest.mark.parametrize(
    ("text", "ours", "theirs"),
    [
        (b"ssid: a password: b", ["a", "b"], ("a", "b")),
        # Split at every space: the first word of the name, the last of the password.
        (b"ssid: my home password: two words", ["my home", "two words"], ("my", "words")),
        (b"ssid: a password: b\r\n", ["a", "b"], ("a", "b\r\n")),
    ],
)
def test_an_account_reads_alike_if_it_has_no_spaces_and_no_line_end(
    text: bytes, ours: list[str], theirs: tuple[str, str], codec: Codec
) -> None:
    assert heard_by_us(codec.name, "get_ssid_pwd", (), text) == ours
    assert heard_by_pymycobot("get_ssid_pwd", (), text) == theirs


def test_every_call_with_a_reply_is_compared() -> None:
    compared = {form.command.name for form in ANSWERS} | {command.name for command in ACKS}
    assert compared == {command.name for command in TABLE.commands if command.reply}
    others = [command for command in TABLE.commands if not command.reply]
    assert [command.name for command in others] == ["get_ssid_pwd", "set_ssid_pwd"]
    assert len(REPLIES) + len(ACKS) == 106
    assert set(DIFFERENCES) < {command.name for command in REPLIES}
