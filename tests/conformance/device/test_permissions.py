"""A run sends only requests of the classes that are permitted by name."""

from __future__ import annotations

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance import Cause
from cobotwire.conformance.device import PERMISSIONS, SUITE, Permissions, parse_workspace
from cobotwire.protocol.errors import ProtocolError, UsageError
from conformance.device.testing import Altered, permissions, prepared

TABLE = editions.load("mycobot280").TABLE
CODEC = codecs.load(TABLE)


def _sent(*classes: str) -> set[str]:
    """Return the safety class of everything that a run sends; ``malformed`` if not a request."""
    received: list[bytes] = []

    def keep(request: bytes, reply: bytes, count: int) -> bytes:
        received.append(request)
        return reply

    prepared(TABLE, lambda arm: Altered(arm, keep), permissions=permissions(*classes)).run()
    return {_class_of(data) for data in received}


def _class_of(data: bytes) -> str:
    try:
        return CODEC.decode("request", data).command.safety.replace(" ", "-")
    except ProtocolError:
        return "malformed"


def test_run_without_permissions_sends_only_queries() -> None:
    assert _sent() == {"query"}


@pytest.mark.parametrize("name", ["setting", "power", "malformed"])
def test_each_class_needs_its_own_permission(name: str) -> None:
    assert _sent(name) == {"query", name}


def test_persistent_writes_need_their_own_permission() -> None:
    # The text with an account is outside any frame.
    assert _sent("persistent-write") - {"malformed"} == {"query", "persistent-write"}


def test_missing_permission_is_reported_for_each_command_and_test_case() -> None:
    report = prepared(TABLE, permissions=permissions()).run()
    skipped = [r for r in report.results if r.cause is Cause.NOT_PERMITTED]
    assert {(r.command, r.case) for r in skipped} >= {
        ("send_angles", "arrives"),
        ("set_joint_min", "read-back"),
        ("get_angles", "wrong-length"),
        ("power_on", "effect"),
    }
    assert all("permission" in r.reason for r in skipped)
    assert report.conforms


@pytest.mark.parametrize(
    ("speed", "space"),
    [
        (None, {j: (-10.0, 10.0) for j in range(1, 7)}),
        (0, {j: (-10.0, 10.0) for j in range(1, 7)}),
        (101, {j: (-10.0, 10.0) for j in range(1, 7)}),
        (50, None),
        (50, {1: (-10.0, 10.0)}),
        (50, {j: (10.0, -10.0) for j in range(1, 7)}),
    ],
)
def test_motion_needs_a_speed_and_a_whole_workspace(
    speed: int | None, space: dict[int, tuple[float, float]] | None
) -> None:
    with pytest.raises(UsageError):
        Permissions.of(["motion"], joints=6, max_speed=speed, workspace=space)


def test_unknown_permission_is_rejected_with_the_known_ones() -> None:
    with pytest.raises(UsageError, match="setting, persistent-write"):
        Permissions.of(["settings"], joints=6)


def test_motion_stays_inside_the_workspace() -> None:
    seen: list[tuple[float, ...]] = []

    def watch(request: bytes, reply: bytes, count: int) -> bytes:
        if reply and reply[3:4] == b"\x20":
            seen.append(CODEC.decode("reply", reply, of="get_angles").values[0])
        return reply

    allowed = permissions("motion", "power")
    prepared(TABLE, lambda arm: Altered(arm, watch), permissions=allowed).run()
    assert len(set(seen)) > 2
    tick = 360 / 4096
    assert all(-60 - tick <= angle <= 60 + tick for angles in seen for angle in angles)


def test_workspace_is_parsed_for_all_joints_or_for_each() -> None:
    assert parse_workspace("-30:30", 2) == {1: (-30.0, 30.0), 2: (-30.0, 30.0)}
    assert parse_workspace("1=-90:90, 2=0:5.5", 2) == {1: (-90.0, 90.0), 2: (0.0, 5.5)}
    for text in ("30", "a:b", "x=1:2"):
        with pytest.raises(UsageError, match="LOW:HIGH"):
            parse_workspace(text, 2)


def test_ids_of_test_cases_are_unique_and_each_permission_has_a_description() -> None:
    assert len({case.id for case in SUITE.cases}) == len(SUITE.cases) > 20
    assert all(PERMISSIONS.values())
