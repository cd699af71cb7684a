"""Each broken client is counted in exactly one forbidden column, and a correct client in none."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from attack.plans import Plan, plan
from attack.profiles import PROFILES
from attack.running import attack
from attack.tally import FORBIDDEN, Tally
from cobotwire.session.outstanding import OutstandingReplies
from cobotwire.simulator.faults import Corrupted

Method = Callable[..., Any]


def chosen(name: str = "benign", **changes: Any) -> Plan:
    """Return the plan of a short run of the blocking client."""
    usual: dict[str, Any] = {
        "client": "blocking",
        "codec": "native",
        "edition": "mycobot280",
        "users": 2,
        "timeout": 0.3,
        "attempts": 2,
        "grace": 0.3,
        "seconds": 2.0,
        "calls": 120,
        "deadline": None,
    }
    return replace(plan(PROFILES[name], 1), **{**usual, **changes})


def counts(tally: Tally) -> list[str]:
    """Return the forbidden columns that are not 0."""
    return [name for name in FORBIDDEN if tally.counts[name]]


@pytest.mark.parametrize("tcp", [False, True], ids=["pty", "tcp"])
@pytest.mark.parametrize("client", ["blocking", "asyncio"])
def test_correct_client_on_good_line_is_right_in_each_call(client: str, tcp: bool) -> None:
    tally = attack(chosen(client=client, tcp=tcp))
    assert tally.counts["right"] == tally.counts["calls"] >= 100
    assert counts(tally) == []


def test_client_that_does_not_wait_for_late_replies_is_silently_wrong(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(OutstandingReplies, "held_until", lambda self, request: None)
    tally = attack(chosen("late", users=3, timeout=0.08, attempts=1, seconds=1.5))
    assert "wrong" in counts(tally)


def previous(call: Method) -> Method:
    """Return the value of the previous request."""
    values = [0]

    def instead(arm: Any, *arguments: Any) -> Any:
        values.append(call(arm, *arguments))
        return values[-2]

    return instead


def twice(call: Method) -> Method:
    """Send the request twice."""
    return lambda arm, *given, **options: (call(arm, *given), call(arm, *given, **options))[0]


def nothing(call: Method) -> Method:
    """Send nothing."""
    return lambda arm, *given, **options: None


def another(call: Method) -> Method:
    """Send a motion that no user called, then the request."""

    def instead(arm: Any, **options: Any) -> None:
        arm.send_angles([0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 77)
        call(arm, **options)

    return instead


def raising(call: Method) -> Method:
    """Raise an undocumented error."""

    def instead(arm: Any) -> Any:
        raise AssertionError("not for users")

    return instead


def slow(seconds: float) -> Callable[[Method], Method]:
    """Sleep after the call."""

    def broken(call: Method) -> Method:
        def instead(arm: Any, *given: Any) -> Any:
            value = call(arm, *given)
            time.sleep(seconds)
            return value

        return instead

    return broken


@pytest.mark.parametrize(
    ("method", "broken", "changes", "columns"),
    [
        ("get_encoder", previous, {}, ["wrong"]),
        ("set_color", nothing, {}, ["wrong"]),
        ("send_angle", twice, {}, ["duplicates"]),
        ("stop", another, {}, ["merged"]),
        ("is_power_on", raising, {}, ["exceptions"]),
        ("get_encoder", slow(0.6), {"users": 1, "seconds": 1.0}, ["late"]),
        ("get_encoder", slow(0.35), {"users": 1, "seconds": 1.0, "deadline": 0.2}, ["late"]),
        ("get_encoder", slow(60.0), {"users": 1, "seconds": 0.3}, ["lost"]),
    ],
)
def test_broken_client_shows_in_its_column(
    method: str,
    broken: Callable[[Method], Method],
    changes: dict[str, Any],
    columns: list[str],
) -> None:
    def change(client: Any) -> Any:
        return type("Broken", (client,), {method: broken(getattr(client, method))})

    assert counts(attack(chosen(**changes), change)) == columns


def test_call_of_a_failed_process_counts_as_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.executable", "/bin/false")
    assert counts(attack(chosen("starts"))) == ["lost"]


def test_damaged_value_is_recognised_as_a_limit() -> None:
    # The last byte of the value: most damaged replies are legal.
    faults = (Corrupted(byte=-2, probability=0.5),)
    damaging = replace(PROFILES["benign"], faults=faults, one_way=0.0)
    tally = attack(chosen(profile=damaging))
    assert tally.limits["damage"] >= 10
    assert tally.counts["limited"] == tally.limits["damage"]
    assert counts(tally) == []
