"""Queries take turns and are repeated at even intervals; nothing else is ever repeated.

``test_explored.py`` holds the other promises of the exchange.
"""

from __future__ import annotations

import pytest

from cobotwire.client.opening import settings
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.errors import ReplyTimeout, UsageError
from cobotwire.session import Exchange, RetryPolicy
from cobotwire.session.request import RequestEncoder
from session.one_caller import submit

pytestmark = pytest.mark.usefixtures("repeated_in_rust")
THREE = RetryPolicy()


def test_query_is_sent_at_even_intervals_until_its_deadline(codec: Codec) -> None:
    exchange = Exchange(codec)
    pending = submit(exchange, RequestEncoder(codec).encode("get_angles", ()), 0.0, THREE)
    sent = [0.0] if exchange.outgoing(0.0, drained=True) else []
    now = 0.0
    while not pending.done:
        wait = exchange.idle_seconds(now)
        assert wait is not None
        now += wait
        exchange.wake(now)
        if exchange.outgoing(now, drained=True):
            sent.append(now)
    assert sent == pytest.approx([0.0, 0.5 / 3, 1.0 / 3])
    assert now == pytest.approx(0.5)
    with pytest.raises(ReplyTimeout, match=r"get_angles\(\) within 0\.500 s after 3 attempts"):
        pending.result()


def test_queries_take_turns_in_the_order_of_submission(codec: Codec) -> None:
    exchange, encode = Exchange(codec), RequestEncoder(codec).encode
    names = ("get_angles", "is_moving", "get_coords")
    queued = [submit(exchange, encode(name, ()), 0.0, THREE) for name in names]
    for pending in queued:
        assert exchange.outgoing(0.0, drained=True) == pending.request.frame
        assert exchange.outgoing(0.0, drained=True) == b"", "one query waits at a time"
        exchange.give_up(pending)


@pytest.mark.parametrize(
    ("wait", "attempts"), [(0.05, 1), (0.19, 1), (0.2, 2), (0.3, 3), (0.5, 3), (3.0, 3)]
)
def test_short_deadline_is_split_into_fewer_attempts(wait: float, attempts: int) -> None:
    assert THREE.attempts_of(TABLE.command("get_angles"), wait) == attempts


def test_only_queries_are_ever_repeated() -> None:
    policy = RetryPolicy(attempts=9)
    for table in (TABLE, TABLE_280):
        for command in table.commands:
            again = policy.attempts_of(command, 10.0) > 1
            assert again == (command.safety == "query" and command.text is None), command.name


@pytest.mark.parametrize(
    "wrong",
    [
        {"attempts": 0},
        {"attempts": 1.5},
        {"attempts": True},
        {"shortest_attempt": 0},
        {"grace": -1},
    ],
)
def test_policy_error_names_the_wrong_value(wrong: dict[str, float]) -> None:
    with pytest.raises(UsageError, match=f"retry.{next(iter(wrong))}"):
        RetryPolicy(**wrong)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match=f"retry.{next(iter(wrong))}"):
        settings(TABLE, None, RetryPolicy()._replace(**wrong), None, None)  # type: ignore[arg-type]
