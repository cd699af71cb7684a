"""Requests of pymycobot's classes for arms with other numbers of joints equal ours, or are listed.

The classes, unmodified, also drive our simulator of their edition over a pty.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cobotwire import codec
from cobotwire.protocol.errors import UsageError
from pymycobot_classes import CLASSES, written
from pymycobot_difference import decoded_by
from pymycobot_rig import READ_BACK, Rig, driven_by
from pymycobot_row_arms import ROW_ARMS, RowArm

BY_EDITION = {arm.edition: arm for arm in ROW_ARMS}


@pytest.fixture(params=BY_EDITION)
def arm(request: pytest.FixtureRequest) -> RowArm:
    return BY_EDITION[request.param]


def test_every_request_equals_pymycobots_bytes(arm: RowArm) -> None:
    for command, given in arm.requests().items():
        for arguments in given:
            ours = written(arm.client("reference"), command, arguments)
            theirs = arm.theirs(command, arguments)
            if command == "set_ssid_pwd":
                theirs = (theirs or b"") + b"'home'(secret words)"
            assert ours == theirs, (command, arguments)
    for method, their_arguments, command, our_arguments in arm.composed:
        assert written(arm.client("reference"), command, our_arguments) == arm.theirs(
            method, their_arguments
        )


def test_both_codecs_send_the_same_requests(arm: RowArm) -> None:
    for command, given in arm.requests().items():
        for arguments in given:
            native = written(arm.client("native"), command, arguments)
            assert native == written(arm.client("reference"), command, arguments), command


def test_every_method_is_compared_or_sends_nothing(arm: RowArm) -> None:
    compared = set(arm.requests()) | {call[0] for call in arm.composed}
    compared |= set(arm.rejected)
    assert compared == arm.methods()


def test_listed_difference_exists(arm: RowArm) -> None:
    for method, (arguments, ruling) in arm.ruled.items():
        try:
            ours = written(arm.client("reference"), method, arguments)
        except UsageError:
            ours = None
        assert ours != arm.theirs(method, arguments), (method, ruling)


def test_frame_that_only_pymycobot_sends_is_rejected(arm: RowArm) -> None:
    for method, (arguments, ruling) in arm.rejected.items():
        sent = arm.theirs(method, arguments)
        assert sent is not None, ruling
        assert decoded_by(codec.load(arm.table, "reference"), sent) == "bad-length"


# What a method of pymycobot returns for a reply, if it is not a whole number.
TYPES: dict[str, type[object]] = {
    "get_angles": list,
    "get_radians": list,
    "get_encoders": list,
    "get_ssid_pwd": tuple,
}
TYPES |= {"get_system_version": float, "get_basic_version": float}
TYPES |= {"get_joint_min_angle": float, "get_joint_max_angle": float}
# No geometry is known, so the simulated arm has no coordinates to report.
NO_REPLY = {"get_coords"}


@pytest.fixture(scope="module", params=BY_EDITION)
def rig(request: pytest.FixtureRequest) -> Iterator[tuple[RowArm, Rig]]:
    arm = BY_EDITION[request.param]
    with driven_by(CLASSES[arm.peer], arm.table) as found:
        found.start_over()
        yield arm, found


def test_every_query_of_pymycobot_gets_a_result_of_the_right_type(rig: tuple[RowArm, Rig]) -> None:
    arm, opened = rig
    requests = arm.requests()
    for command in arm.table.commands:
        if not command.requires_reply or command.name in NO_REPLY:
            continue
        result = getattr(opened.peer, command.name)(*requests[command.name][0])
        kind = TYPES.get(command.name, int)
        result = result[0] if kind is int and isinstance(result, list) else result
        assert (type(result), result == -1) == (kind, False), (command.name, result)
        assert arm.table.command(opened.received[-1]).id == command.id
    assert opened.rejected == []


def test_values_that_pymycobot_sets_read_back(rig: tuple[RowArm, Rig]) -> None:
    arm, opened = rig
    opened.start_over()
    target = [float(10 * n) for n in range(1, arm.table.joints)] + [-90.0]
    opened.peer.send_angles(target, 100)
    opened.settle()
    opened.advance(60)
    assert opened.peer.get_angles() == pytest.approx(target, abs=READ_BACK)
    assert opened.peer.is_in_position(target, 0) == 1
    opened.peer.set_joint_max(2, 45)
    assert opened.peer.get_joint_max_angle(2) == 45.0
    opened.peer.set_encoders([2048] * arm.table.joints, 100)
    opened.settle()
    opened.advance(60)
    assert opened.peer.get_encoders() == [2048] * arm.table.joints
    for setter, getter, value in (
        ("set_speed", "get_speed", 30),
        ("set_acceleration", "get_acceleration", 7),
        ("set_free_mode", "is_free_mode", 1),
    ):
        if hasattr(opened.peer, setter):
            getattr(opened.peer, setter)(value)
            result = getattr(opened.peer, getter)()
            assert result == [value] or result == value, getter
    assert opened.rejected == []
