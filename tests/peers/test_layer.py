"""Our classes with the maker's names, compared with the maker's classes."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

import cobotwire.pymycobot as ours
from cobotwire.pymycobot.layer.absent import why_absent
from layer_comparison import FAILED, REJECTED, call_ours, compare, layer_on
from layer_robots import CLOSED_LOOP, LAYER_ROBOTS, PALLETIZER, SAME_ROBOT
from layer_rulings import FRAMES, MISTAKES, OTHER_FRAMES, PARAMETERS, RESULTS, UNANSWERED
from pymycobot_classes import library, peer_on
from pymycobot_ports import RecordingPort, RecordingTransport
from robots.comparison import calls_of

CLASSES = [name for name in ours.__all__ if name in ours._MODULES]
# The classes that report the end of motions have a module of their own.
COMPARED = {*LAYER_ROBOTS} - {*CLOSED_LOOP}
# Of each method, one of so many calls: fewer for a class whose robot another class compares, too.
STRIDE, SPARSE = 5, 15


def _parameters(method: Any) -> list[tuple[str, Any]]:
    return [
        (each.name, each.default)
        for each in inspect.signature(method).parameters.values()
        if each.kind is not each.KEYWORD_ONLY
    ]


def _public(kind: type) -> set[str]:
    return {name for name in dir(kind) if not name.startswith("_")}


@pytest.mark.parametrize("name", CLASSES)
def test_class_has_the_methods_and_parameters_of_the_makers(name: str) -> None:
    theirs, mine = library(name), getattr(ours, name)
    absent = _public(theirs) - _public(mine)
    assert {each for each in absent if not why_absent(mine, each)} == set()
    assert _public(mine) - _public(theirs) <= {
        "ACK_SECONDS",
        "ELSEWHERE",
        "LATE",
        "NATIVE",
        "ORDERS",
        "PORTS",
        "QUIET",
        "close",
        "open",
        "go_home",
        "gpio_init",
        "gpio_output",
    }
    shared = (_public(theirs) & _public(mine)) | {"__init__"}
    # Some attributes are constants.
    shared = {each for each in shared if callable(getattr(theirs, each))}
    different = {
        each: (_parameters(getattr(theirs, each)), _parameters(getattr(mine, each)))
        for each in shared
        if _parameters(getattr(theirs, each)) != _parameters(getattr(mine, each))
        and (name, each) not in PARAMETERS
    }
    assert different == {}


# It reads the language of the system in a way that Python deprecates.
@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
@pytest.mark.parametrize("name", [name for name in CLASSES if name in COMPARED])
def test_frames_and_results_equal_those_of_the_makers_class(name: str) -> None:
    found = compare(LAYER_ROBOTS[name], SPARSE if name in SAME_ROBOT else STRIDE)
    assert found.open == []
    assert found.equal >= (30 if name in SAME_ROBOT else 50)
    ruled = {method for _, method in (*RESULTS, *OTHER_FRAMES, *UNANSWERED, *MISTAKES)}
    assert found.needed <= {*FRAMES, *ruled}


def test_each_call_of_the_makers_palletizer_fails_and_ours_succeeds() -> None:
    theirs = peer_on("MyPalletizer", RecordingPort())
    with pytest.raises(ValueError, match="too many values to unpack"):
        theirs.get_angles()
    calls = {call.method: call for call in calls_of(PALLETIZER) if not call.why}
    assert len(calls) >= 40
    results = {name: call_ours(PALLETIZER, call).result for name, call in calls.items()}
    rejected = {name for name, result in results.items() if result in (REJECTED, FAILED)}
    # No source gives the geometry, so the simulated arm does not reply to the first; the call of
    # the second lacks the mode that this class wants.
    assert rejected == {"get_coords", "sync_send_coords"}


def test_name_without_counterpart_raises_error_with_reason() -> None:
    buddy = layer_on("MyBuddySocket", RecordingTransport())
    with pytest.raises(AttributeError, match=r"'set_color'.* in the place of the address"):
        buddy.set_color(255, 0, 0)
    with pytest.raises(AttributeError, match=r"'ping': .*bus of the servos"):
        buddy.ping(1)
    assert not hasattr(buddy, "set_color")
    with pytest.raises(AttributeError, match=r"no attribute 'gibberish'$"):
        _ = buddy.gibberish


def test_argument_that_the_edition_cannot_send_is_rejected() -> None:
    arm = layer_on("MyPalletizer", RecordingTransport())
    with pytest.raises(ValueError, match="mode is 1; allowed: None, as the edition"):
        arm.send_coords([200, 0, 100, 9], 50, 1)


def test_address_that_the_robot_lacks_is_rejected() -> None:
    buddy = layer_on("MyBuddy", RecordingTransport())
    with pytest.raises(ValueError, match="id is 7; allowed: ALL"):
        buddy.get_angles(7)
