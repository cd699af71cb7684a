"""Devices that are broken by hand fail, with the rule and the command that say where."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.conformance import Verdict
from cobotwire.sim import SimulatedArm
from cobotwire.sim.behaviour import BEHAVIOUR
from conformance.device.testing import Altered, bad, leave, prepared

TABLE = editions.load("mycobot280").TABLE
Alter = Callable[[bytes, bytes, int], bytes]


def _of(command: str, change: Callable[[bytes], bytes]) -> Alter:
    """Change the answers to one command."""
    id = TABLE.command(command).id
    return lambda request, answer, count: (
        change(answer) if answer and request[3:4] == bytes([id]) else answer
    )


def _byte(at: int, change: Callable[[int], int]) -> Callable[[bytes], bytes]:
    return lambda a: a[:at] + bytes([change(a[at]) % 256]) + a[at + 1 :]


BROKEN: Mapping[str, tuple[Alter, str, str]] = {
    "no answer": (_of("get_angles", lambda a: b""), "query-answered", "get_angles"),
    "two answers": (_of("get_angles", lambda a: a * 2), "reply-once", "get_angles"),
    "a stray byte": (_of("get_coords", lambda a: a + b"\x07"), "reply-once", "get_coords"),
    "a frame nobody asked for": (
        _of("get_coords", lambda a: a + bytes.fromhex("FE FE 03 12 01 FA")),
        "reply-once",
        "get_coords",
    ),
    "wrong LEN": (_of("get_encoders", _byte(2, lambda b: b - 1)), "reply-frame", "get_encoders"),
    "wrong footer": (_of("is_moving", _byte(-1 % 6, lambda b: 0xFB)), "reply-frame", "is_moving"),
    "wrong id": (_of("is_moving", _byte(3, lambda b: b + 1)), "query-answered", "is_moving"),
    "a flag of 2": (_of("is_power_on", _byte(4, lambda b: 2)), "reply-fields", "is_power_on"),
    "another joint": (
        _of("is_servo_enable", _byte(4, lambda b: b % 6 + 1)),
        "reply-echo",
        "is_servo_enable",
    ),
    "bytes swapped": (
        _of("get_tool_reference", lambda a: a[:4] + a[5:6] + a[4:5] + a[6:]),
        "read-back",
        "set_tool_reference",
    ),
    "two acknowledgements": (_of("set_color", lambda a: a * 2), "order-acknowledged", "set_color"),
    "never acknowledged": (_of("set_color", lambda a: b""), "acks-alike", ""),
    "acknowledged by 0": (
        _of("set_color", lambda a: bytes.fromhex("FE FE 03 6A 00 FA")),
        "order-acknowledged",
        "set_color",
    ),
    "another angle than the encoder's": (
        _of("get_encoders", _byte(5, lambda b: b + 30)),
        "agrees",
        "get_encoders",
    ),
    "unlike each other": (
        lambda request, answer, count: (
            answer[:4] + bytes([count % 256]) + answer[5:]
            if request[3:4] == b"\x01" and answer
            else answer
        ),
        "reply-repeats",
        "get_modify_version",
    ),
    "text in place of silence for an unknown id is a refusal, a frame is not": (
        lambda request, answer, count: (
            bytes.fromhex("FE FE 02 03 FA") if request[3:4] == b"\x00" else answer
        ),
        "unknown-id",
        "",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_broken_is_found_where_it_is(name: str) -> None:
    alter, rule, command = BROKEN[name]
    report = prepared(TABLE, lambda arm: Altered(arm, alter)).run()
    found = {(result.rule, result.command) for result in bad(report)}
    assert (rule, command) in found
    assert not report.conforms


BEHAVIOURS: dict[str, tuple[str, Callable[[Any], Any], str]] = {
    "ignored": ("set_joint_min", lambda real: lambda arm, now, **a: None, "read-back"),
    "the next joint": (
        "set_joint_max",
        lambda real: lambda arm, now, joint, angle: real(arm, now, joint % 6 + 1, angle),
        "read-back",
    ),
    "all joints": (
        "set_joint_max",
        lambda real: (
            lambda arm, now, joint, angle: (
                [real(arm, now, each, angle) for each in range(1, 7)] and None
            )
        ),
        "neighbours-stay",
    ),
    "a tenth": (
        "set_world_reference",
        lambda real: lambda arm, now, coords: real(arm, now, tuple(c / 10 for c in coords)),
        "read-back",
    ),
    "does not move": ("send_angles", lambda real: lambda arm, now, **a: None, "arrives"),
    "does not stop": ("stop", lambda real: lambda arm, now: None, "stops"),
    "stays on": ("power_off", lambda real: lambda arm, now: None, "effect"),
}


@pytest.mark.parametrize("name", BEHAVIOURS)
def test_what_behaves_otherwise_is_found(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    command, make, rule = BEHAVIOURS[name]
    monkeypatch.setitem(BEHAVIOUR, command, make(BEHAVIOUR[command]))
    assert (rule, command) in {(r.rule, r.command) for r in bad(prepared(TABLE).run())}


class _Late:
    """Answers get_angles after its deadline."""

    def __init__(self, arm: SimulatedArm) -> None:
        self._arm, self._said = arm, b""
        self.wait: float | None = None

    def receive(self, data: bytes) -> bytes:
        answer = self._arm.receive(data)
        if data[3:4] != b"\x20":
            return answer
        self._said, self.wait = answer, 0.6
        return b""

    def flush(self) -> bytes:
        said, self._said, self.wait = self._said, b"", None
        return said + self._arm.flush()


def test_a_late_reply_fails_and_says_how_late() -> None:
    report = prepared(TABLE, _Late, leave=leave()).run()
    [late] = [r for r in bad(report) if (r.rule, r.command) == ("query-answered", "get_angles")]
    assert "within 500 ms" in late.reason
    assert "after 600 ms" in late.reason


def test_a_device_that_answers_now_and_then_is_unstable() -> None:
    seen = 0

    def alter(request: bytes, answer: bytes, count: int) -> bytes:
        nonlocal seen
        seen += request[3:4] == b"\x2b"
        return b"" if request[3:4] == b"\x2b" and seen <= 2 else answer

    report = prepared(TABLE, lambda arm: Altered(arm, alter), leave=leave(), repeat=3).run()
    [moving] = [r for r in report.results if (r.rule, r.command) == ("query-answered", "is_moving")]
    assert moving.verdict is Verdict.UNSTABLE
    assert "1 of 3 runs" in moving.reason


def test_what_the_arm_may_lack_is_not_supported() -> None:
    lacks = Altered
    alter = _of("get_tof_distance", lambda a: b"")
    report = prepared(
        TABLE,
        lambda arm: lacks(arm, alter),
        leave=leave(),
        optional=frozenset({"get_tof_distance"}),
    ).run()
    verdicts = {r.verdict for r in report.results if r.command == "get_tof_distance"}
    assert Verdict.NOT_SUPPORTED in verdicts
    assert report.conforms
