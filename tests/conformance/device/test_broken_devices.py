"""A device broken by hand fails exactly the test case and the command that name its fault."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.conformance import Cause
from cobotwire.editions.mycobot280.messages import SetJointMax, SetWorldReference
from cobotwire.protocol.messages import Request
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.behaviour import BEHAVIOURS, Behaviour
from cobotwire.simulator.behaviour.registry import Behave
from cobotwire.simulator.state import ArmState
from conformance.device.testing import Altered, bad, permissions, prepared

TABLE = editions.load("mycobot280").TABLE
Alter = Callable[[bytes, bytes, int], bytes]


def _of(command: str, change: Callable[[bytes], bytes]) -> Alter:
    """Change the replies to one command."""
    id = TABLE.command(command).id
    return lambda request, reply, count: (
        change(reply) if reply and request[3:4] == bytes([id]) else reply
    )


def _byte(at: int, change: Callable[[int], int]) -> Callable[[bytes], bytes]:
    return lambda a: a[:at] + bytes([change(a[at]) % 256]) + a[at + 1 :]


BROKEN: Mapping[str, tuple[Alter, str, str]] = {
    "no reply": (_of("get_angles", lambda a: b""), "query-replied", "get_angles"),
    "two replies": (_of("get_angles", lambda a: a * 2), "reply-once", "get_angles"),
    "a stray byte": (_of("get_coords", lambda a: a + b"\x07"), "reply-once", "get_coords"),
    "a frame that was not requested": (
        _of("get_coords", lambda a: a + bytes.fromhex("FE FE 03 12 01 FA")),
        "reply-once",
        "get_coords",
    ),
    "wrong LEN": (_of("get_encoders", _byte(2, lambda b: b - 1)), "reply-frame", "get_encoders"),
    "wrong footer": (_of("is_moving", _byte(-1 % 6, lambda b: 0xFB)), "reply-frame", "is_moving"),
    "wrong id": (_of("is_moving", _byte(3, lambda b: b + 1)), "query-replied", "is_moving"),
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
    "two acknowledgements": (_of("set_color", lambda a: a * 2), "acknowledgement", "set_color"),
    "never acknowledged": (_of("set_color", lambda a: b""), "acknowledgements-alike", ""),
    "acknowledged by 0": (
        _of("set_color", lambda a: bytes.fromhex("FE FE 03 6A 00 FA")),
        "acknowledgement",
        "set_color",
    ),
    "another angle than the encoder's": (
        _of("get_encoders", _byte(5, lambda b: b + 30)),
        "agrees",
        "get_encoders",
    ),
    "unlike each other": (
        lambda request, reply, count: (
            reply[:4] + bytes([count % 256]) + reply[5:]
            if request[3:4] == b"\x01" and reply
            else reply
        ),
        "reply-repeats",
        "get_modify_version",
    ),
    "a frame in reply to an unknown id": (
        lambda request, reply, count: (
            bytes.fromhex("FE FE 02 03 FA") if request[3:4] == b"\x00" else reply
        ),
        "unknown-id",
        "",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_reply_fails_its_test_case_and_command(name: str) -> None:
    alter, case, command = BROKEN[name]
    report = prepared(TABLE, lambda arm: Altered(arm, alter)).run()
    found = {(result.case, result.command) for result in bad(report)}
    assert (case, command) in found
    assert not report.conforms


def _ignored(arm: ArmState, now: float, request: Request[Any]) -> None:
    """Do nothing."""


def _next_joint(arm: ArmState, now: float, request: SetJointMax) -> None:
    """Set the limit of the next joint."""
    _set_joint_max(arm, now, SetJointMax(request.joint % 6 + 1, request.angle))


def _all_joints(arm: ArmState, now: float, request: SetJointMax) -> None:
    """Set the limits of all joints."""
    for joint in range(1, 7):
        _set_joint_max(arm, now, SetJointMax(joint, request.angle))


def _tenth(arm: ArmState, now: float, request: SetWorldReference) -> None:
    """Set a tenth of the coordinates."""
    arm.world = tuple(coord / 10 for coord in request.coords)


_set_joint_max = BEHAVIOURS["set_joint_max"].behave
# For each fault: the command, its wrong behaviour, and the test case that fails.
WRONG: dict[str, tuple[str, Behave, str]] = {
    "ignored": ("set_joint_min", _ignored, "read-back"),
    "the next joint": ("set_joint_max", _next_joint, "read-back"),
    "all joints": ("set_joint_max", _all_joints, "neighbours-stay"),
    "a tenth": ("set_world_reference", _tenth, "read-back"),
    "does not move": ("send_angles", _ignored, "arrives"),
    "does not stop": ("stop", _ignored, "stops"),
    "stays on": ("power_off", _ignored, "effect"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_behaviour_fails_its_test_case(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    command, behave, case = WRONG[name]
    request = TABLE.command(command).request_type
    assert request is not None
    monkeypatch.setitem(BEHAVIOURS, command, Behaviour(request, behave))
    assert (case, command) in {(r.case, r.command) for r in bad(prepared(TABLE).run())}


class _Late:
    """Replies to get_angles after its deadline."""

    def __init__(self, arm: SimulatedArm) -> None:
        self._arm, self._reply = arm, b""
        self.wait: float | None = None

    def receive(self, data: bytes) -> bytes:
        reply = self._arm.receive(data)
        if data[3:4] != b"\x20":
            return reply
        self._reply, self.wait = reply, 0.6
        return b""

    def flush(self) -> bytes:
        reply, self._reply, self.wait = self._reply, b"", None
        return reply + self._arm.flush()


def test_late_reply_fails_with_its_time() -> None:
    report = prepared(TABLE, _Late, permissions=permissions()).run()
    [late] = [r for r in bad(report) if (r.case, r.command) == ("query-replied", "get_angles")]
    assert "within 500 ms" in late.reason
    assert "after 600 ms" in late.reason


def test_device_that_replies_sometimes_is_unstable() -> None:
    seen = 0

    def alter(request: bytes, reply: bytes, count: int) -> bytes:
        nonlocal seen
        seen += request[3:4] == b"\x2b"
        return b"" if request[3:4] == b"\x2b" and seen <= 2 else reply

    report = prepared(
        TABLE, lambda arm: Altered(arm, alter), permissions=permissions(), repeat=3
    ).run()
    [moving] = [r for r in report.results if (r.case, r.command) == ("query-replied", "is_moving")]
    assert moving.outcome == "fail (unstable)"
    assert "1 of 3 runs" in moving.reason


def test_optional_command_without_a_reply_is_not_supported() -> None:
    lacks = Altered
    alter = _of("get_tof_distance", lambda a: b"")
    report = prepared(
        TABLE,
        lambda arm: lacks(arm, alter),
        permissions=permissions(),
        optional=frozenset({"get_tof_distance"}),
    ).run()
    causes = {r.cause for r in report.results if r.command == "get_tof_distance"}
    assert Cause.NOT_SUPPORTED in causes
    assert report.conforms
