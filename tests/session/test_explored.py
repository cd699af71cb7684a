"""Explore every order of events up to a stated number; find a planted fault in each rule."""

from __future__ import annotations

from math import inf
from typing import Any

import pytest

from cobotwire.session import Exchange, PendingRequest, RetryPolicy
from cobotwire.session import exchange as exchanges
from cobotwire.session.acks import Acks, ExpectedAck
from cobotwire.session.alignment import Alignment
from cobotwire.session.echo import EchoDetector
from cobotwire.session.outstanding import OutstandingReplies, PersistedState
from session.exploring.__main__ import main
from session.exploring.explorer import Search
from session.exploring.topics import TOPICS

# How many events in a row `make test` explores; `make explore` explores longer sequences. In
# "settings", "damage" and "writes", three events find every planted fault that four events find.
DEPTHS = {"everything": 2, "settings": 3, "damage": 3, "writes": 3, "unread": 5}
USUAL_DEPTH = 4


@pytest.mark.parametrize("topic", TOPICS)
def test_no_order_of_events_breaks_a_promise(topic: str) -> None:
    search = Search(TOPICS[topic])
    while search.depth < DEPTHS.get(topic, USUAL_DEPTH) and not search.found:
        search.deepen()
    print(f"\n{topic}: {search}")
    assert not search.found, search.found


def _no(*arguments: Any) -> None:
    """Do nothing, in place of a rule."""


def _held_longer(replies: OutstandingReplies, request: Any) -> float | None:
    until = _held_until(replies, request)
    return until and until + 0.5


def _settling_late(replies: OutstandingReplies, frame: Any, now: float) -> Any:
    found = _find(replies, frame, now)
    if found is not None:
        replies.settle(found)
    return found


def _expiring_unflushed(exchange: Exchange, waiting: PendingRequest, now: float) -> list[Any]:
    return exchange._expire(waiting, now, now - waiting.requested_at)


def _only_parts(exchange: Exchange, now: float) -> PersistedState:
    return _persist(exchange, now)._replace(late=())


def _only_late(exchange: Exchange, now: float) -> PersistedState:
    return _persist(exchange, now)._replace(parts=())


_held_until, _find = OutstandingReplies.held_until, OutstandingReplies.find
_outgoing, _persist = Exchange.outgoing, Exchange.persist
_late, _request = OutstandingReplies, PendingRequest
# By fault: the topic, the requests and the promise that reveal it, and the rule that is replaced.
FAULTS: dict[str, tuple[str, str, str, Any, str, Any]] = {
    "not held": ("queries", "plain", "settled by", _late, "held_until", _no),
    "held for too long": ("queries", "plain", "held", _late, "held_until", _held_longer),
    "late reply forgotten": ("queries", "plain", "settled by", _late, "expect_late", _no),
    "late reply expected once": ("queries", "plain", "settled by", _late, "find", _settling_late),
    "repeats forgotten": ("queries", "plain", "settled by", _request, "repeated", False),
    "motion repeated": (
        *("queries", "moving query", "sent more than", RetryPolicy, "attempts_of"),
        lambda policy, *_: policy.attempts,
    ),
    "other arguments repeated": (
        *("queries", "pin 1,pin 2", "settled by", exchanges, "repeats_arguments"),
        lambda *_: True,
    ),
    "no end of the wait": ("queries", "plain", "no time to wake", _request, "ends_at", inf),
    "no deadline": ("queries", "hurried", "deadline", Exchange, "end_overdue", lambda *_: []),
    "no end of the wait for an ack": ("settings", "color", "deadline", Acks, "wake", _no),
    "ack of another": ("settings", "color", "not acknowledged", ExpectedAck, "doubt", _no),
    "undrained": (
        *("unread", "plain", "settled by", Exchange, "outgoing"),
        lambda exchange, now, drained: _outgoing(exchange, now, drained=True),
    ),
    "slow write ignored": ("unread", "plain", "settled by", Exchange, "written", _no),
    "copy counts at once": (
        *("echoes", "servo", "settled by nothing", _request, "keep_candidate"),
        lambda pending, message: pending.reply(message.fields, 0.0),
    ),
    "copy not recognized": (
        *("echoes", "servo", "settled by an echo", EchoDetector, "take_copy"),
        lambda *_: False,
    ),
    "echo not noticed": (
        *("echoes", "plain,servo", "settled by an echo", EchoDetector, "add_noise"),
        _no,
    ),
    "hidden frame lost": (
        *("damage", "plain,long", "came in time", Exchange, "_end_wait"),
        _expiring_unflushed,
    ),
    "cut forgotten": ("writes", "pin 1,motion", "arm did not", Alignment, "cut", _no),
    "loss cuts nothing": ("writes", "pin 1,motion", "arm did not", Alignment, "lose", _no),
    "frame inside exposed": (
        *("writes", "frame inside", "nobody sent", Alignment, "_exposes"),
        lambda *_: False,
    ),
    "cut not persisted": ("writes", "pin 1,motion", "arm did not", Exchange, "persist", _only_late),
    "late reply not persisted": (
        *("reopening", "plain", "settled by", Exchange, "persist"),
        _only_parts,
    ),
    "late reply not restored": ("reopening", "plain", "settled by", Exchange, "restore", _no),
    "loss leaves no late reply": (
        *("reopening", "plain", "settled by", Exchange, "fail_waiting"),
        lambda exchange, error: exchange.sent_last and exchange.sent_last.fail(error),
    ),
}


@pytest.mark.parametrize("rule", FAULTS)
def test_planted_fault_is_found(rule: str, monkeypatch: pytest.MonkeyPatch) -> None:
    topic, kinds, broken, owner, name, replacement = FAULTS[rule]
    monkeypatch.setattr(owner, name, replacement)
    search = Search(TOPICS[topic]._replace(kinds=tuple(kinds.split(","))))
    while not search.found and len(search.seen) < 5000:
        search.deepen()
    print(f"\n{rule}, after {len(search.seen)} states: {search.found}")
    assert broken in search.found


def test_make_explore_prints_counts_limits_and_the_shortest_sequence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(400) == 0
    assert "0 broken promises; limits met: first copy" in capsys.readouterr().out
    monkeypatch.setattr(Acks, "wake", _no)
    assert main(400) == 1
    assert "after: call color; then time passes" in capsys.readouterr().out
