"""Single requests and their replies; the test provides bytes and times."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import (
    LateReply,
    ReplyMatched,
    ReplyRejected,
    RequestExpired,
    UnexpectedFrame,
)
from session.one_caller import OneCaller

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
TEXT = b"ssid: one two password: three four"


def test_request_waits_until_its_reply_is_complete(codec: Codec) -> None:
    session = OneCaller(codec)
    assert session.wake_at is None
    assert session.request("get_angles", (), now=10.0) == bytes.fromhex("FE FE 02 20 FA")
    assert session.wake_at == 10.5
    assert session.receive(ANGLES[:9], now=10.1) == []
    [event] = session.receive(ANGLES[9:], now=10.2)
    assert isinstance(event, ReplyMatched)
    assert event.fields == {"angles": (1.4, 0.61, -0.26, -1.93, 1.75, -1.75)}
    assert not session.waiting


def test_deadline_ends_the_wait_once(codec: Codec) -> None:
    session = OneCaller(codec)
    session.request("get_angles", (), now=0.0, timeout=0.2)
    assert session.wake(0.19) == []
    assert session.wake(0.2) == [RequestExpired(TABLE.command("get_angles"), 0.0)]
    assert session.wake(9.0) == []
    [late] = session.receive(ANGLES, now=0.3)
    assert isinstance(late, LateReply)


def test_frame_that_began_before_the_request_is_not_its_reply(codec: Codec) -> None:
    session = OneCaller(codec)
    session.receive(ANGLES[:9], now=0.0)
    session.request("get_angles", (), now=0.1)
    [late] = session.receive(ANGLES[9:], now=0.2)
    assert isinstance(late, UnexpectedFrame)
    [reply] = session.receive(ANGLES, now=0.3)
    assert isinstance(reply, ReplyMatched)


def test_illegal_reply_ends_the_wait_with_its_reason(codec: Codec) -> None:
    session = OneCaller(codec)
    session.request("is_power_on", (), now=0.0)
    [event] = session.receive(bytes.fromhex("FE FE 03 12 02 FA"), now=0.1)
    assert isinstance(event, ReplyRejected)
    assert event.error.reason == "bad-value"


@given(
    st.sampled_from(["reference", "native"]),
    st.lists(st.sampled_from([ANGLES, POWERED, b"\xff\xff\x01\x02", b"\xfe", TEXT]), max_size=6),
    st.lists(st.integers(1, 9), max_size=40),
)
def test_every_received_byte_is_in_one_event(
    name: codecs.CodecName, pieces: list[bytes], cuts: list[int]
) -> None:
    session = OneCaller(codecs.load(TABLE, name))
    session.request("get_angles", (), now=0.0)
    stream = b"".join(pieces)
    received = b""
    replies = 0
    rest = stream
    for cut in [*cuts, len(stream)]:
        chunk, rest = rest[:cut], rest[cut:]
        for event in session.receive(chunk, now=0.1):
            if isinstance(event, Noise):
                received += event.data
            elif isinstance(event, UnexpectedFrame):
                received += event.frame.data
            elif isinstance(event, ReplyMatched):
                received += ANGLES
                replies += 1
    # Bytes that may begin a frame are in no event until more bytes arrive.
    assert stream.startswith(received)
    assert len(stream) - len(received) < TABLE.frame.maximum_length + TABLE.frame.overhead
    assert replies <= 1
