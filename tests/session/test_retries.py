"""Queries take turns; only queries are ever repeated.

``test_explored.py`` holds the other promises of the exchange. ``test_rust_exchange.py`` compares
with Rust when queries are repeated.
"""

from __future__ import annotations

import pytest

from cobotwire.client.opening import settings
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.errors import UsageError
from cobotwire.session import Exchange, RetryPolicy
from cobotwire.session.request import RequestEncoder
from session.one_caller import submit

pytestmark = pytest.mark.usefixtures("repeated_in_rust")
THREE = RetryPolicy()


def test_queries_take_turns_in_the_order_of_submission(codec: Codec) -> None:
    exchange, encode = Exchange(codec), RequestEncoder(codec).encode
    names = ("get_angles", "is_moving", "get_coords")
    queued = [submit(exchange, encode(name, ()), 0.0, THREE) for name in names]
    for pending in queued:
        assert exchange.outgoing(0.0, drained=True) == pending.request.frame
        assert exchange.outgoing(0.0, drained=True) == b"", "one query waits at a time"
        exchange.give_up(pending)


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
