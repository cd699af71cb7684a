"""Only queries are ever repeated, and a retry policy names the value that is wrong.

``test_explored.py`` checks the other promises of the exchange, ``test_rust_exchange.py`` when
queries are repeated.
"""

from __future__ import annotations

import pytest

from cobotwire.client.opening import settings
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.errors import UsageError
from cobotwire.session import RetryPolicy


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
