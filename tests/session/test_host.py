"""The asking side of the conversation, with bytes and times that the test owns."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.errors import UsageError
from cobotwire.session import Answered, Expired, HostSession, Late, Refused, Unasked

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
TEXT = b"ssid: one two password: three four"


def test_a_request_waits_until_its_reply(codec: Codec) -> None:
    session = HostSession(codec)
    assert session.wake_at is None
    assert session.request("get_angles", (), now=10.0) == bytes.fromhex("FE FE 02 20 FA")
    assert session.wake_at == 10.5
    assert session.receive(ANGLES[:9], now=10.1) == []
    [event] = session.receive(ANGLES[9:], now=10.2)
    assert isinstance(event, Answered)
    assert event.fields == {"angles": (1.4, 0.61, -0.26, -1.93, 1.75, -1.75)}
    assert not session.waiting


def test_a_second_request_is_refused_while_one_waits(codec: Codec) -> None:
    session = HostSession(codec)
    session.request("get_angles", (), now=0.0)
    with pytest.raises(UsageError, match="get_angles waits"):
        session.request("get_coords", (), now=0.1)
    session.abandon()
    session.request("get_coords", (), now=0.1)


def test_a_bad_argument_changes_nothing(codec: Codec) -> None:
    session = HostSession(codec)
    with pytest.raises(UsageError):
        session.request("get_encoder", (9,), now=0.0)
    assert not session.waiting


def test_the_deadline_ends_the_wait_once(codec: Codec) -> None:
    session = HostSession(codec)
    session.request("get_angles", (), now=0.0, timeout=0.2)
    assert session.wake(0.19) == []
    assert session.wake(0.2) == [Expired(TABLE.command("get_angles"), 0.0)]
    assert session.wake(9.0) == []
    [late] = session.receive(ANGLES, now=0.3)
    assert isinstance(late, Late)


def test_a_frame_that_had_begun_before_the_question_is_not_its_answer(codec: Codec) -> None:
    session = HostSession(codec)
    session.receive(ANGLES[:9], now=0.0)
    session.request("get_angles", (), now=0.1)
    [late] = session.receive(ANGLES[9:], now=0.2)
    assert isinstance(late, Unasked)
    [reply] = session.receive(ANGLES, now=0.3)
    assert isinstance(reply, Answered)


def test_an_illegal_reply_ends_the_wait_with_its_reason(codec: Codec) -> None:
    session = HostSession(codec)
    session.request("is_power_on", (), now=0.0)
    [event] = session.receive(bytes.fromhex("FE FE 03 12 02 FA"), now=0.1)
    assert isinstance(event, Refused)
    assert event.error.reason == "bad-value"


def test_a_text_reply_ends_by_silence(codec: Codec) -> None:
    session = HostSession(codec)
    session.request("get_ssid_pwd", (), now=0.0)
    session.receive(TEXT[:10], now=0.10)
    silence = TABLE.command("get_ssid_pwd").text
    assert silence is not None
    assert session.wake_at == pytest.approx(0.10 + silence.silence_ms / 1000)
    session.receive(TEXT[10:], now=0.12)
    assert session.wake(0.13) == []
    [event] = [e for e in session.wake(0.5) if not isinstance(e, Noise)]
    assert isinstance(event, Answered)
    assert event.fields == {"ssid": "one two", "password": "three four"}


def test_a_text_that_never_falls_silent_is_no_reply(codec: Codec) -> None:
    session = HostSession(codec)
    session.request("get_ssid_pwd", (), now=0.0)
    now = 0.0
    events = []
    while session.waiting and now < 5.0:
        now += 0.01
        events = session.receive(b"x", now) + session.wake(now)
    assert [type(event) for event in events if not isinstance(event, Noise)] == [Expired]


@given(
    st.sampled_from(["reference", "native"]),
    st.lists(st.sampled_from([ANGLES, POWERED, b"\xff\xff\x01\x02", b"\xfe", TEXT]), max_size=6),
    st.lists(st.integers(1, 9), max_size=40),
)
def test_nothing_that_was_heard_is_lost(
    name: codecs.CodecName, pieces: list[bytes], cuts: list[int]
) -> None:
    session = HostSession(codecs.load(TABLE, name))
    session.request("get_angles", (), now=0.0)
    stream = b"".join(pieces)
    heard = b""
    answers = 0
    rest = stream
    for cut in [*cuts, len(stream)]:
        chunk, rest = rest[:cut], rest[cut:]
        for event in session.receive(chunk, now=0.1):
            if isinstance(event, Noise):
                heard += event.data
            elif isinstance(event, Unasked):
                heard += event.frame.data
            elif isinstance(event, Answered):
                heard += ANGLES
                answers += 1
    # What still waits for more bytes is the only thing that no event has told.
    assert stream.startswith(heard)
    assert len(stream) - len(heard) < TABLE.frame.maximum_length + TABLE.frame.overhead
    assert answers <= 1
