"""A device that breaks a law of addresses, speeds or settings fails the case that names it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance import Result, Verdict
from cobotwire.conformance.device import ALL_PERMISSIONS
from cobotwire.protocol.table import Table
from cobotwire.simulator.state import ArmState
from conformance.device.testing import Altered, permissions, prepared

ROBOT = editions.load("mybuddy").TABLE
ARM = editions.load("mycobot280_rdkx5").TABLE
WAIST = 3


def _from_waist(command: str) -> Callable[[bytes, bytes, int], bytes]:
    """Let replies to a command come from the waist. The sum does not cover the address."""
    id = ROBOT.command(command).id
    return lambda request, reply, count: (
        reply[:2] + bytes([WAIST]) + reply[3:] if reply and request[4:5] == bytes([id]) else reply
    )


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
    altered = _from_waist("get_speed")
    failed = _failures(
        ROBOT, "queries", "get_speed", wrap=lambda arm: Altered(arm, altered), address="LEFT"
    )
    [frame] = [result for result in failed if result.case == "reply-frame"]
    assert "address 01 (LEFT)" in frame.reason
    assert "received the frame FE FE 03" in frame.reason


def test_row_of_six_joints_from_the_waist_fails_also_if_all_parts_are_requested() -> None:
    altered = _from_waist("get_angles")
    failed = _failures(ROBOT, "queries", "get_angles", wrap=lambda arm: Altered(arm, altered))
    [frame] = [result for result in failed if result.case == "reply-frame"]
    assert "a device that has all of these joints" in frame.reason


def test_one_number_from_the_waist_is_a_reply_if_all_parts_are_requested() -> None:
    altered = _from_waist("get_speed")
    assert not _failures(ROBOT, "queries", "get_speed", wrap=lambda arm: Altered(arm, altered))


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


def test_message_names_what_a_query_reports_by_the_names_of_its_values() -> None:
    table = editions.load("mercury_a1").TABLE
    codec, query = codecs.load(table), table.command("is_drag_fifo_empty")

    def altered(request: bytes, reply: bytes, count: int) -> bytes:
        if request[3:4] != bytes([query.id]):
            return reply
        content = codec.decode("reply", reply, of=query.name).fields["content"]
        return codec.encode(query.name, "reply", [1 - content])

    options = {"wrap": lambda arm: Altered(arm, altered)}
    [result] = _failures(table, "recorded points", "set_drag_fifo", **options)
    assert f"{query.name}: expected EMPTY, with 0 points; received FILLED" in result.reason


def test_setting_fails_if_no_number_of_a_row_reports_it() -> None:
    shown = bytes.fromhex("FE FE 01 04 D0 32 32 34")

    def altered(request: bytes, reply: bytes, count: int) -> bytes:
        return shown if reply and request[4:5] == shown[4:5] else reply

    options = {"wrap": lambda arm: Altered(arm, altered), "address": "LEFT"}
    failed = _failures(ROBOT, "set among others", "set_plan_speed", **options)
    assert [result.case for result in failed] == ["set-is-reported"]
    assert not _failures(ROBOT, "set among others", "set_plan_acceleration", **options)
