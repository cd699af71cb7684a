"""Each column counts what its title says: each broken client shows in one column, and a correct
client in none."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import pytest

from attack.plans import Plan, plan
from attack.profiles import PROFILES
from attack.running import attack
from attack.tally import FORBIDDEN, Tally
from cobotwire.session.outstanding import OutstandingReplies
from cobotwire.simulator.faults import Corrupted


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


def test_value_of_another_request_is_silently_wrong() -> None:
    def change(client: Any) -> Any:
        class Stale(client):  # type: ignore[misc]
            last = 0

            def get_encoder(self, joint: int) -> int:
                before, Stale.last = Stale.last, super().get_encoder(joint)
                return before

        return Stale

    assert counts(attack(chosen(), change)) == ["wrong"]


def test_late_reply_that_is_not_waited_for_is_silently_wrong(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(OutstandingReplies, "held_until", lambda self, request: None)
    tally = attack(chosen("late", users=3, timeout=0.08, attempts=1, seconds=1.5))
    assert "wrong" in counts(tally)


def test_setter_that_sends_nothing_is_silently_wrong() -> None:
    def change(client: Any) -> Any:
        class Mute(client):  # type: ignore[misc]
            def set_color(self, *arguments: Any, **options: Any) -> None:
                pass

        return Mute

    assert counts(attack(chosen(), change)) == ["wrong"]


def test_motion_that_is_sent_twice_is_a_duplicate() -> None:
    def change(client: Any) -> Any:
        class Twice(client):  # type: ignore[misc]
            def send_angle(self, *arguments: Any, **options: Any) -> None:
                super().send_angle(*arguments)
                super().send_angle(*arguments, **options)

        return Twice

    assert counts(attack(chosen(), change)) == ["duplicates"]


def test_motion_that_nobody_called_is_merged() -> None:
    def change(client: Any) -> Any:
        class Own(client):  # type: ignore[misc]
            def stop(self, **options: Any) -> None:
                super().send_angles([0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 77)
                super().stop(**options)

        return Own

    assert counts(attack(chosen(), change)) == ["merged"]


def test_undocumented_exception_is_counted() -> None:
    def change(client: Any) -> Any:
        class Raising(client):  # type: ignore[misc]
            def is_power_on(self) -> bool:
                raise AssertionError("not for users")

        return Raising

    assert counts(attack(chosen(), change)) == ["exceptions"]


@pytest.mark.parametrize(("deadline", "slept"), [(None, 0.6), (0.2, 0.35)])
def test_call_that_ends_after_its_deadline_is_late(deadline: float | None, slept: float) -> None:
    def change(client: Any) -> Any:
        class Slow(client):  # type: ignore[misc]
            def get_encoder(self, joint: int) -> int:
                value: int = super().get_encoder(joint)
                time.sleep(slept)
                return value

        return Slow

    assert "late" in counts(attack(chosen(users=1, seconds=1.0, deadline=deadline), change))


def test_call_that_never_ends_is_lost() -> None:
    def change(client: Any) -> Any:
        class Waiting(client):  # type: ignore[misc]
            def get_encoder(self, joint: int) -> int:
                time.sleep(60.0)
                return 0

        return Waiting

    assert counts(attack(chosen(users=1, seconds=0.3), change)) == ["lost"]


def test_process_that_fails_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
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
