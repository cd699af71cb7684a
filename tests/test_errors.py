"""Errors survive pickling and copying, so that they can cross processes."""

from __future__ import annotations

import copy
import pickle

import pytest

from cobotwire.protocol.errors import (
    ArmNotReady,
    CaptureError,
    CobotwireError,
    EditionUnknown,
    FollowFailed,
    LinkError,
    MotionTimeout,
    OutputError,
    ProtocolError,
    ReplyTimeout,
    ScenarioError,
    StatementError,
    UsageError,
)

ERRORS = [
    UsageError("angles[2]", 400, "-160..160 degrees"),
    ProtocolError("bad-value", 4, b"\xfe\xfe", "is_power_on: powered holds 7"),
    LinkError("/dev/ttyACM0", "it is gone", 3),
    ReplyTimeout("get_angles", 0.5, ("noise",), 3, "get_angles()"),
    MotionTimeout((1.0, 2.0), 3.0, True),
    EditionUnknown("/dev/ttyACM0", ("is_power_on: no reply",)),
    FollowFailed("no target came for 0.5 s", ("a report",)),
    ArmNotReady("send_angles", False, ("the arm has no power",)),
    CaptureError("a.pcapng", 12, "it is cut off"),
    OutputError("out/a.parquet", "the disk is full"),
    ScenarioError(["a.yaml:1:2: there is no fault losst", "a.yaml:2:1: nothing"]),
    StatementError(["a.yaml:1:2: commands has no key get_angle", "a.yaml:2:1: nothing"]),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize(
    "way", [lambda e: pickle.loads(pickle.dumps(e)), copy.copy], ids=["pickled", "copied"]
)
def test_pickled_or_copied_error_equals_the_original(error: CobotwireError, way: object) -> None:
    assert callable(way)
    again = way(error)
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)


def test_list_of_errors_holds_every_branch_of_the_root_error() -> None:
    found = CobotwireError.__subclasses__()
    branches = {kind for kind in found if kind.__module__ == "cobotwire.protocol.errors"}
    assert branches == {type(error) for error in ERRORS}


def nested(depth: int) -> list[object]:
    """Return a list that is nested more deeply than Python can write."""
    found: list[object] = []
    for _ in range(depth):
        found = [found]
    return found


@pytest.mark.parametrize(
    "value", [10**5000, [-(10**5000)], nested(100_000)], ids=["int", "list", "deep"]
)
def test_value_that_cannot_be_written_is_named_by_its_type(value: object) -> None:
    with pytest.raises(ValueError, match="that is too long to be shown; allowed: few"):
        raise UsageError("joint", value, "few")
