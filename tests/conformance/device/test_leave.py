"""Nothing goes over the line that was not allowed by name."""

from __future__ import annotations

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance import Verdict
from cobotwire.conformance.device import CLASSES, RULES, Leave, workspace_of
from cobotwire.errors import ProtocolError, UsageError
from conformance.device.testing import Altered, leave, prepared

TABLE = editions.load("mycobot280").TABLE
CODEC = codecs.load(TABLE)


def _sent(*classes: str) -> set[str]:
    """The safety classes of all that a run sends; ``malformed`` where it is no request."""
    heard: list[bytes] = []

    def keep(request: bytes, answer: bytes, count: int) -> bytes:
        heard.append(request)
        return answer

    prepared(TABLE, lambda arm: Altered(arm, keep), leave=leave(*classes)).run()
    return {_class_of(data) for data in heard}


def _class_of(data: bytes) -> str:
    try:
        return CODEC.decode("request", data).command.safety.replace(" ", "-")
    except ProtocolError:
        return "malformed"


def test_without_leave_only_queries_are_sent() -> None:
    assert _sent() == {"query"}


@pytest.mark.parametrize("name", ["setting", "power", "malformed"])
def test_each_class_needs_its_own_leave(name: str) -> None:
    assert _sent(name) == {"query", name}


def test_persistent_writes_need_their_own_leave() -> None:
    # The text of an account stands outside any frame.
    assert _sent("persistent-write") - {"malformed"} == {"query", "persistent-write"}


def test_what_is_not_allowed_is_told_for_each_command_and_rule() -> None:
    report = prepared(TABLE, leave=leave()).run()
    refused = [r for r in report.results if r.verdict is Verdict.NOT_ALLOWED]
    assert {(r.command, r.rule) for r in refused} >= {
        ("send_angles", "arrives"),
        ("set_joint_min", "read-back"),
        ("get_angles", "wrong-length"),
        ("power_on", "effect"),
    }
    assert all("leave" in r.reason for r in refused)
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
        Leave.of(["motion"], joints=6, max_speed=speed, workspace=space)


def test_an_unknown_class_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UsageError, match="setting, persistent-write"):
        Leave.of(["settings"], joints=6)


def test_motion_stays_inside_the_workspace() -> None:
    seen: list[tuple[float, ...]] = []

    def watch(request: bytes, answer: bytes, count: int) -> bytes:
        if answer and answer[3:4] == b"\x20":
            seen.append(CODEC.decode("reply", answer, of="get_angles").values[0])
        return answer

    allowed = leave("motion", "power")
    prepared(TABLE, lambda arm: Altered(arm, watch), leave=allowed).run()
    assert len(set(seen)) > 2
    tick = 360 / 4096
    assert all(-60 - tick <= angle <= 60 + tick for angles in seen for angle in angles)


def test_a_workspace_is_written_for_all_joints_or_for_each() -> None:
    assert workspace_of("-30:30", 2) == {1: (-30.0, 30.0), 2: (-30.0, 30.0)}
    assert workspace_of("1=-90:90, 2=0:5.5", 2) == {1: (-90.0, 90.0), 2: (0.0, 5.5)}
    for text in ("30", "a:b", "x=1:2"):
        with pytest.raises(UsageError, match="LOW:HIGH"):
            workspace_of(text, 2)


def test_the_ids_of_rules_are_unique_and_the_classes_are_said() -> None:
    assert len({rule.id for rule in RULES}) == len(RULES) > 20
    assert all(CLASSES.values())
