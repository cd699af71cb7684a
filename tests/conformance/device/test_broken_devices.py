"""A device with a fault fails the test case and the command that name the fault.

Most broken devices are in tests/mutation and tests/defects; this file has the others.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import count
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance import Cause, Result, Verdict
from cobotwire.conformance.device import ALL_PERMISSIONS
from cobotwire.protocol.table import Table
from cobotwire.simulator.state import ArmState
from conformance.device.testing import altering, permissions, prepared, results_of

TABLE = editions.load("mycobot280").TABLE
ROBOT = editions.load("mybuddy").TABLE
ARM = editions.load("mycobot280_rdkx5").TABLE
WAIST = 3
NUMBERS = count()
# The command, the change of its reply, and the test case that fails.
BROKEN: Mapping[str, tuple[str, Callable[[bytes], bytes], str]] = {
    "a stray byte": ("get_coords", lambda reply: reply + b"\x07", "reply-once"),
    "a frame that was not requested": (
        "get_coords",
        lambda reply: reply + bytes.fromhex("FE FE 03 12 01 FA"),
        "reply-once",
    ),
    "acknowledged by 0": (
        "set_color",
        lambda reply: bytes.fromhex("FE FE 03 6A 00 FA"),
        "acknowledgement",
    ),
    "replies that differ": (
        "get_modify_version",
        lambda reply: reply[:4] + bytes([next(NUMBERS) % 256]) + reply[5:],
        "reply-repeats",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_reply_fails_its_test_case_and_command(name: str) -> None:
    command, change, case = BROKEN[name]
    found = results_of(prepared(TABLE, altering(TABLE, command, change)), command)
    assert case in {result.case for result in found if result.verdict is Verdict.FAIL}


def test_device_that_replies_sometimes_is_unstable() -> None:
    seen = count()
    silent_at_first = altering(TABLE, "is_moving", lambda a: a if next(seen) >= 2 else b"")
    report = prepared(TABLE, silent_at_first, permissions=permissions(), repeat=3).run()
    [moving] = [r for r in report.results if (r.case, r.command) == ("query-replied", "is_moving")]
    assert moving.outcome == "fail (unstable)"
    assert "1 of 3 runs" in moving.reason


def test_optional_command_without_a_reply_is_not_supported() -> None:
    name = "get_tof_distance"
    options: dict[str, Any] = {"permissions": permissions(), "optional": frozenset({name})}
    found = results_of(prepared(TABLE, altering(TABLE, name, lambda a: b""), **options), name)
    assert Cause.NOT_SUPPORTED in {result.cause for result in found}
    assert Verdict.FAIL not in {result.verdict for result in found}


def _from_waist(reply: bytes) -> bytes:
    """Return a reply from the waist. The sum does not cover the address."""
    return reply[:2] + bytes([WAIST]) + reply[3:]


def _failures(table: Table, group: str, command: str, **options: Any) -> list[Result]:
    """Run one group on one command; return what fails."""
    tester = prepared(
        table, permissions=permissions(*ALL_PERMISSIONS, joints=table.joints), **options
    )
    [step] = [
        step
        for step in tester.steps()
        if step.group.name == group and step.command is table.command(command)
    ]
    results = list(tester.results(step))
    assert {Verdict.PASS, Verdict.FAIL} & {result.verdict for result in results}
    return [result for result in results if result.verdict is Verdict.FAIL]


def test_reply_of_another_address_fails_with_the_expected_address() -> None:
    wrap = altering(ROBOT, "get_speed", _from_waist)
    failed = _failures(ROBOT, "queries", "get_speed", wrap=wrap, address="LEFT")
    [frame] = [result for result in failed if result.case == "reply-frame"]
    assert "address 01 (LEFT)" in frame.reason
    assert "received the frame FE FE 03" in frame.reason


def test_row_of_six_joints_from_the_waist_fails_also_if_all_parts_are_requested() -> None:
    wrap = altering(ROBOT, "get_angles", _from_waist)
    failed = _failures(ROBOT, "queries", "get_angles", wrap=wrap)
    [frame] = [result for result in failed if result.case == "reply-frame"]
    assert "a device that has all joints that the request names" in frame.reason


def test_one_number_from_the_waist_is_a_reply_if_all_parts_are_requested() -> None:
    wrap = altering(ROBOT, "get_speed", _from_waist)
    assert not _failures(ROBOT, "queries", "get_speed", wrap=wrap)


def _stands(arm: ArmState, now: float) -> tuple[int, ...]:
    return (0,) * arm.joints


def _swapped(arm: ArmState, now: float) -> tuple[int, ...]:
    first, second, *rest = SPEEDS(arm, now)
    return (second, first, *rest)


def _never_rests(arm: ArmState, now: float) -> tuple[int, ...]:
    return tuple(speed or 200 for speed in SPEEDS(arm, now))


SPEEDS = ArmState.servo_speeds


@pytest.mark.parametrize(
    ("wrong", "named"),
    [(_stands, "on the way: joint 1: 0,"), (_swapped, "joint 1"), (_never_rests, "joint 2: 17.6")],
)
def test_wrong_speed_of_a_servo_fails(
    wrong: Callable[[ArmState, float], tuple[int, ...]],
    named: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert not _failures(ARM, "reported speeds", "get_servo_speeds")
    monkeypatch.setattr(ArmState, "servo_speeds", wrong)
    [result] = _failures(ARM, "reported speeds", "get_servo_speeds")
    assert result.case == "speeds-reported"
    assert named in result.reason


def test_reason_shows_enum_members_by_name() -> None:
    table = editions.load("mercury_a1").TABLE
    codec, query = codecs.load(table), table.command("is_drag_fifo_empty")

    def inverted(reply: bytes) -> bytes:
        content = codec.decode("reply", reply, of=query.name).fields["content"]
        return codec.encode(query.name, "reply", [1 - content])

    wrap = altering(table, query.name, inverted)
    [result] = _failures(table, "recorded points", "set_drag_fifo", wrap=wrap)
    assert f"{query.name}: expected EMPTY, with 0 points; received FILLED" in result.reason


def test_setting_fails_if_no_number_of_a_row_reports_it() -> None:
    shown = bytes.fromhex("FE FE 01 04 D0 32 32 34")
    wrap = altering(ROBOT, "get_plan_speed", lambda reply: shown)
    options: dict[str, Any] = {"wrap": wrap, "address": "LEFT"}
    failed = _failures(ROBOT, "set among others", "set_plan_speed", **options)
    assert [result.case for result in failed] == ["set-is-reported"]
    assert not _failures(ROBOT, "set among others", "set_plan_acceleration", **options)
