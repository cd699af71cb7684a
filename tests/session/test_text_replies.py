"""A text reply outside any frame, on a line that also carries other bytes."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import ReplyMatched, ReplyRejected, RequestExpired, SessionEvent
from cobotwire.session.text import TEXT_LIMIT
from session.one_caller import OneCaller

TEXT = b"ssid: one two password: three four"
ACCOUNT = {"ssid": "one two", "password": "three four"}
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")
VARIANT = TABLE.command("get_ssid_pwd").text
assert VARIANT is not None
SILENCE = VARIANT.silence_ms / 1000
DEADLINE = 0.5


@pytest.fixture
def session(codec: Codec) -> OneCaller:
    made = OneCaller(codec)
    made.request("get_ssid_pwd", (), now=0.0, timeout=DEADLINE)
    return made


def ending(events: list[SessionEvent]) -> SessionEvent | None:
    found = [e for e in events if isinstance(e, ReplyMatched | ReplyRejected | RequestExpired)]
    assert len(found) <= 1
    return found[0] if found else None


def test_pause_of_100_ms_inside_the_text_does_not_end_it(session: OneCaller) -> None:
    session.receive(TEXT[:15], 0.05)
    assert session.wake(0.15) == []
    session.receive(TEXT[15:], 0.15)
    matched = ending(session.wake(0.15 + SILENCE))
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == ACCOUNT


@pytest.mark.parametrize(
    "before", [LEAK, POWERED, b"cmd_len error\r\n", b"\xfe", b"ssid", bytes(9)]
)
def test_bytes_before_the_text_do_not_change_the_wait(session: OneCaller, before: bytes) -> None:
    session.receive(before, 0.01)
    assert session.wake_at == DEADLINE, "the silence starts with the text"
    assert session.wake(0.01 + SILENCE) == []
    events = session.receive(TEXT, 0.4)
    matched = ending(session.wake(0.4 + SILENCE))
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == ACCOUNT
    assert any(isinstance(event, Noise) for event in events), "the text is also reported as noise"


def test_frame_after_the_text_does_not_delay_it(session: OneCaller) -> None:
    session.receive(TEXT, 0.1)
    session.receive(POWERED + b"\xfe", 0.1 + SILENCE / 2)
    assert session.wake_at == pytest.approx(0.1 + SILENCE)
    matched = ending(session.wake(0.1 + SILENCE))
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == ACCOUNT


def test_late_wake_still_reads_the_text(session: OneCaller) -> None:
    session.receive(TEXT, 0.1)
    assert isinstance(ending(session.wake(60.0)), ReplyMatched)


def test_text_that_began_before_the_deadline_may_end_after_it(session: OneCaller) -> None:
    session.receive(TEXT[:20], DEADLINE - 0.1)
    session.receive(TEXT[20:], DEADLINE - 0.01)
    assert session.wake(DEADLINE) == []
    assert isinstance(ending(session.wake(DEADLINE - 0.01 + SILENCE)), ReplyMatched)


def test_text_must_end_one_silence_after_the_deadline(session: OneCaller) -> None:
    session.receive(TEXT, DEADLINE - 0.01)
    session.receive(b"x", DEADLINE + 0.1)
    assert session.wake_at == DEADLINE + SILENCE
    assert isinstance(ending(session.wake(DEADLINE + SILENCE)), RequestExpired)


def test_wait_without_text_ends_at_the_deadline(session: OneCaller) -> None:
    session.receive(LEAK, DEADLINE - 0.01)
    assert isinstance(ending(session.wake(DEADLINE)), RequestExpired)


def test_text_hidden_after_a_false_header_is_found_at_the_deadline(
    session: OneCaller,
) -> None:
    session.receive(bytes.fromhex("FE FE 0E 20") + b"ssid: a", 0.1)
    assert ending(session.wake(DEADLINE)) is None, "the text has only begun"
    session.receive(b" password: b", DEADLINE + 0.05)
    assert isinstance(ending(session.wake(DEADLINE + SILENCE)), RequestExpired)


def test_text_that_began_before_the_request_is_not_its_reply(codec: Codec) -> None:
    session = OneCaller(codec)
    # The false header keeps the framer from reporting the text before the request is sent.
    session.receive(bytes.fromhex("FE FE 0E 20") + b"ssid: old", 0.0)
    session.request("get_ssid_pwd", (), now=0.1, timeout=DEADLINE)
    session.receive(b" password: older", 0.2)
    assert isinstance(ending(session.wake(9.0)), RequestExpired)


def test_endless_text_is_bounded_in_time_and_memory(session: OneCaller) -> None:
    now, events = 0.0, session.receive(b"ssid: ", 0.0)
    while session.waiting:
        now += 0.01
        events = session.receive(b"x" * 1000, now) + session.wake(now)
    assert isinstance(ending(events), RequestExpired)
    assert now < DEADLINE + SILENCE + 0.02


def test_text_that_is_too_long_is_rejected(session: OneCaller) -> None:
    session.receive(TEXT + b"x" * TEXT_LIMIT, 0.1)
    rejected = ending(session.wake(0.4))
    assert isinstance(rejected, ReplyRejected)
    assert "longer than" in str(rejected.error)
