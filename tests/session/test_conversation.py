"""What callers who share a line can rely on; bytes and times are the test's."""

from __future__ import annotations

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.errors import LinkError, ReplyTimeout, UsageError
from cobotwire.session import Conversation, Question, RetryPolicy

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
ASK_ANGLES = bytes.fromhex("FE FE 02 20 FA")
ASK_POWER = bytes.fromhex("FE FE 02 12 FA")
THREE = RetryPolicy()
ONCE = RetryPolicy(tries=1)


@pytest.fixture
def talk(codec: Codec) -> Conversation:
    return Conversation(codec)


@pytest.fixture(params=["reference", "native"])
def talk_280(request: pytest.FixtureRequest) -> Conversation:
    """The edition with acknowledgements."""
    return Conversation(codecs.load(TABLE_280, request.param))


def ask(talk: Conversation, name: str, *values: int, now: float = 0.0) -> Question:
    return talk.ask(talk.prepare(name, values), now, THREE)


def test_questions_take_turns_in_the_order_in_which_they_were_asked(talk: Conversation) -> None:
    first, second = ask(talk, "get_angles"), ask(talk, "is_power_on")
    assert talk.outgoing(0.0, dry=True) == ASK_ANGLES
    assert talk.outgoing(0.0, dry=True) == b""
    talk.receive(ANGLES, 0.01)
    assert first.done
    assert first.result()["angles"][0] == 1.4
    assert talk.outgoing(0.01, dry=True) == ASK_POWER
    talk.receive(POWERED, 0.02)
    assert second.result() == {"powered": 1}
    assert talk.wait(0.02) is None


def test_a_query_is_asked_again_at_even_times_and_ends_at_its_deadline(talk: Conversation) -> None:
    question = ask(talk, "get_angles")
    sent = [0.0] if talk.outgoing(0.0, dry=True) else []
    now = 0.0
    while not question.done:
        wait = talk.wait(now)
        assert wait is not None
        now += wait
        talk.wake(now)
        if talk.outgoing(now, dry=True):
            sent.append(now)
    assert sent == pytest.approx([0.0, 0.5 / 3, 1.0 / 3])
    assert now == pytest.approx(0.5)
    with pytest.raises(ReplyTimeout, match=r"get_angles within 0\.500 s, asked 3 times"):
        question.result()


@pytest.mark.parametrize(
    ("wait", "tries"), [(0.05, 1), (0.19, 1), (0.2, 2), (0.3, 3), (0.5, 3), (3.0, 3)]
)
def test_a_short_deadline_is_split_into_fewer_tries(wait: float, tries: int) -> None:
    assert THREE.tries_of(TABLE.command("get_angles"), wait) == tries


def test_only_queries_are_ever_asked_again() -> None:
    policy = RetryPolicy(tries=9)
    for table in (TABLE, TABLE_280):
        for command in table.commands:
            again = policy.tries_of(command, 10.0) > 1
            assert again == (command.safety == "query" and command.text is None), command.name


@pytest.mark.parametrize(
    "wrong", [{"tries": 0}, {"tries": 1.5}, {"tries": True}, {"shortest": 0}, {"grace": -1}]
)
def test_a_policy_that_is_none_is_named(wrong: dict[str, float]) -> None:
    with pytest.raises(UsageError, match=f"retry.{next(iter(wrong))}"):
        RetryPolicy(**wrong)  # type: ignore[arg-type]


def test_an_order_goes_out_at_once_while_a_question_waits(talk: Conversation) -> None:
    question = ask(talk, "get_angles")
    talk.outgoing(0.0, dry=True)
    data, ticket = talk.order(talk.prepare("stop", ()), 0.01)
    assert data == bytes.fromhex("FE FE 02 29 FA")
    assert ticket is None
    talk.receive(ANGLES, 0.02)
    assert question.done


def test_the_echo_of_an_order_does_not_hide_the_echo_of_the_question(talk: Conversation) -> None:
    question = ask(talk, "is_servo_enable", 1)
    asked = talk.outgoing(0.0, dry=True)
    ordered, _ = talk.order(talk.prepare("stop", ()), 0.01)
    talk.receive(asked + ordered, 0.02)
    assert not question.done, "the first copy of the question is its echo"


def test_a_held_question_is_overtaken_by_one_that_is_not(talk: Conversation) -> None:
    lost = ask(talk, "get_encoder", 1)
    talk.outgoing(0.0, dry=True)
    talk.give_up(lost)
    held, free = ask(talk, "get_encoder", 2), ask(talk, "is_power_on")
    assert talk.outgoing(0.1, dry=True) == ASK_POWER
    talk.receive(POWERED, 0.2)
    assert free.done
    assert talk.outgoing(0.3, dry=True) == b""
    assert talk.wait(0.3) == pytest.approx(0.7)
    assert talk.outgoing(1.0, dry=True) == bytes.fromhex("FE FE 03 3B 02 FA")
    assert not held.done


def test_after_a_second_try_the_reply_to_the_first_holds_the_next_question(
    talk: Conversation,
) -> None:
    question = ask(talk, "get_angles")
    talk.outgoing(0.0, dry=True)
    assert talk.outgoing(0.2, dry=True) == ASK_ANGLES
    talk.receive(ANGLES, 0.3)
    assert question.done
    again = ask(talk, "get_angles", now=0.3)
    assert talk.outgoing(0.3, dry=True) == b"", "the other reply could be taken for its own"
    talk.receive(ANGLES, 0.35)
    assert not again.done
    assert talk.outgoing(0.35, dry=True) == ASK_ANGLES


def test_the_grace_is_the_callers(talk: Conversation) -> None:
    for tries in range(2):
        talk.ask(talk.prepare("get_angles", ()), 0.0, RetryPolicy(tries=2, grace=0.1), 0.4)
        assert tries or talk.outgoing(0.0, dry=True)
    talk.outgoing(0.2, dry=True)
    talk.receive(ANGLES, 0.21)
    assert talk.outgoing(0.29, dry=True) == b""
    assert talk.outgoing(0.31, dry=True) == ASK_ANGLES


def test_a_line_that_is_never_dry_does_not_keep_a_question_for_ever(talk: Conversation) -> None:
    ask(talk, "get_angles")
    assert talk.outgoing(0.0, dry=False) == b""
    assert talk.outgoing(0.06, dry=False) == ASK_ANGLES


def test_a_link_that_is_gone_ends_everything_that_waits(talk_280: Conversation) -> None:
    asked, queued = ask(talk_280, "get_angles"), ask(talk_280, "is_power_on")
    talk_280.outgoing(0.0, dry=True)
    _, order = talk_280.order(talk_280.prepare("stop", ()), 0.0, ack_within=1.0)
    talk_280.fail(LinkError("port", "is gone"))
    assert order is not None
    for ticket in (asked, queued, order):
        with pytest.raises(LinkError, match="port: is gone"):
            ticket.result()


def test_an_acknowledgement_ends_the_order_that_wants_it(talk_280: Conversation) -> None:
    request = talk_280.prepare("set_color", (1, 2, 3))
    _, order = talk_280.order(request, 0.0, ack_within=0.5)
    assert order is not None
    assert talk_280.wait(0.1) == pytest.approx(0.4)
    talk_280.receive(bytes.fromhex("FE FE 03 6A 01 FA"), 0.2)
    assert order.done
    order.result()


def test_an_order_that_is_not_acknowledged_says_so(talk_280: Conversation) -> None:
    _, order = talk_280.order(talk_280.prepare("set_color", (1, 2, 3)), 0.0, ack_within=0.5)
    talk_280.receive(b"cmd_len error", 0.2)
    talk_280.wake(0.5)
    assert order is not None
    with pytest.raises(ReplyTimeout, match=r"set_color\(red=1, green=2, blue=3\).*63 6D 64"):
        order.result()


def test_of_two_alike_neither_is_acknowledged_by_one(talk_280: Conversation) -> None:
    request = talk_280.prepare("set_color", (1, 2, 3))
    talk_280.order(request, 0.0)
    _, second = talk_280.order(request, 0.1, ack_within=0.5)
    assert second is not None
    talk_280.receive(bytes.fromhex("FE FE 03 6A 01 FA"), 0.2)
    assert not second.done
    talk_280.receive(bytes.fromhex("FE FE 03 6A 01 FA"), 0.3)
    assert second.done


def test_a_bare_acknowledgement_that_may_be_an_echo_counts_at_the_end(
    talk_280: Conversation,
) -> None:
    data, order = talk_280.order(talk_280.prepare("stop", ()), 0.0, ack_within=0.5)
    talk_280.receive(data, 0.1)
    assert order is not None
    assert not order.done
    talk_280.wake(0.5)
    order.result()


def test_an_interrupt_between_two_steps_leaves_nobody_waiting_for_ever(talk: Conversation) -> None:
    question = ask(talk, "get_angles")
    # As Ctrl-C leaves it between the two steps of sending.
    talk._queue.clear()
    talk._asked = question
    assert talk.wait(0.0) == 0.0
    assert talk.outgoing(0.0, dry=True) == ASK_ANGLES
    talk._host.abandon()
    talk.wait(0.1)
    with pytest.raises(ReplyTimeout):
        question.result()
