"""A reply outside any frame, on a line that also carries other things."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import Answered, Expired, HostSession, Refused, SessionEvent
from cobotwire.session.listening import TEXT_LIMIT

TEXT = b"ssid: one two password: three four"
ACCOUNT = {"ssid": "one two", "password": "three four"}
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")
FORM = TABLE.command("get_ssid_pwd").text
assert FORM is not None
SILENCE = FORM.silence_ms / 1000
DEADLINE = 0.5


@pytest.fixture
def session(codec: Codec) -> HostSession:
    made = HostSession(codec)
    made.request("get_ssid_pwd", (), now=0.0, timeout=DEADLINE)
    return made


def verdict(events: list[SessionEvent]) -> SessionEvent | None:
    found = [e for e in events if isinstance(e, Answered | Refused | Expired)]
    assert len(found) <= 1
    return found[0] if found else None


def test_a_pause_of_100_ms_inside_the_text_does_not_end_it(session: HostSession) -> None:
    session.receive(TEXT[:15], 0.05)
    assert session.wake(0.15) == []
    session.receive(TEXT[15:], 0.15)
    answer = verdict(session.wake(0.15 + SILENCE))
    assert isinstance(answer, Answered)
    assert answer.fields == ACCOUNT


@pytest.mark.parametrize(
    "before", [LEAK, POWERED, b"cmd_len error\r\n", b"\xfe", b"ssid", bytes(9)]
)
def test_what_comes_before_the_text_neither_ends_nor_spoils_the_wait(
    session: HostSession, before: bytes
) -> None:
    session.receive(before, 0.01)
    assert session.wake_at == DEADLINE, "the silence starts with the text"
    assert session.wake(0.01 + SILENCE) == []
    heard = session.receive(TEXT, 0.4)
    answer = verdict(session.wake(0.4 + SILENCE))
    assert isinstance(answer, Answered)
    assert answer.fields == ACCOUNT
    assert any(isinstance(event, Noise) for event in heard), "it is told as noise all the same"


def test_a_frame_behind_the_text_does_not_hold_it_up(session: HostSession) -> None:
    session.receive(TEXT, 0.1)
    session.receive(POWERED + b"\xfe", 0.1 + SILENCE / 2)
    assert session.wake_at == pytest.approx(0.1 + SILENCE)
    answer = verdict(session.wake(0.1 + SILENCE))
    assert isinstance(answer, Answered)
    assert answer.fields == ACCOUNT


def test_a_wake_that_comes_late_still_reads_the_text(session: HostSession) -> None:
    session.receive(TEXT, 0.1)
    assert isinstance(verdict(session.wake(60.0)), Answered)


def test_a_text_that_began_before_the_deadline_may_end_behind_it(session: HostSession) -> None:
    session.receive(TEXT[:20], DEADLINE - 0.1)
    session.receive(TEXT[20:], DEADLINE - 0.01)
    assert session.wake(DEADLINE) == []
    assert isinstance(verdict(session.wake(DEADLINE - 0.01 + SILENCE)), Answered)


def test_but_not_so_late_that_babble_could_go_on_for_ever(session: HostSession) -> None:
    session.receive(TEXT, DEADLINE - 0.01)
    session.receive(b"x", DEADLINE + 0.1)
    assert session.wake_at == DEADLINE + SILENCE
    assert isinstance(verdict(session.wake(DEADLINE + SILENCE)), Expired)


def test_a_wait_without_text_ends_at_the_deadline(session: HostSession) -> None:
    session.receive(LEAK, DEADLINE - 0.01)
    assert isinstance(verdict(session.wake(DEADLINE)), Expired)


def test_a_text_hidden_behind_a_false_header_is_found_at_the_deadline(
    session: HostSession,
) -> None:
    session.receive(bytes.fromhex("FE FE 0E 20") + b"ssid: a", 0.1)
    assert verdict(session.wake(DEADLINE)) is None, "it has only begun"
    session.receive(b" password: b", DEADLINE + 0.05)
    assert isinstance(verdict(session.wake(DEADLINE + SILENCE)), Expired)


def test_a_text_that_had_begun_before_the_question_is_not_its_answer(codec: Codec) -> None:
    session = HostSession(codec)
    # The false header keeps the framer from telling the text before the question is asked.
    session.receive(bytes.fromhex("FE FE 0E 20") + b"ssid: old", 0.0)
    session.request("get_ssid_pwd", (), now=0.1, timeout=DEADLINE)
    session.receive(b" password: older", 0.2)
    assert isinstance(verdict(session.wake(9.0)), Expired)


def test_babble_is_bounded_in_time_and_in_memory(session: HostSession) -> None:
    now, events = 0.0, session.receive(b"ssid: ", 0.0)
    while session.waiting:
        now += 0.01
        events = session.receive(b"x" * 1000, now) + session.wake(now)
    assert isinstance(verdict(events), Expired)
    assert now < DEADLINE + SILENCE + 0.02


def test_a_text_that_is_too_long_is_no_answer(session: HostSession) -> None:
    session.receive(TEXT + b"x" * TEXT_LIMIT, 0.1)
    refused = verdict(session.wake(0.4))
    assert isinstance(refused, Refused)
    assert "longer than" in str(refused.error)
