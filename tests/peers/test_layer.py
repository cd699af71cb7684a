"""Our classes with the maker's names, compared with the maker's classes."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

import cobotwire.pymycobot as ours
from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.layer.absent import why_absent
from cobotwire.pymycobot.layer.data import NAMES
from differences import rulings, unruled
from layer_comparison import FAILED, REJECTED, Called, call_ours, layer_on
from layer_main import COMPARISONS
from layer_robots import ALL_ROBOTS, PALLETIZER, SOCKETS
from layer_sockets import compare_sockets
from pymycobot_classes import library, peer_on
from pymycobot_ports import RecordingPort, RecordingTransport
from robots.comparison import calls_of

CLASSES = sorted(NAMES)
# `make layer` compares all methods; here every n-th one.
EVERY = {"calls": 12, "values": 45, "replies": 30}
EVERY_BY_TCP = 40
FAILURES = (REJECTED, FAILED)
# By class and method: where our parameters are others.
PARAMETERS = {
    ("MyArmSocket", "sync_send_coords"): "mode has the default of the serial class",
    ("MyCobotSocket", "sync_send_coords"): "mode has the default of the serial class",
}


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
deprecated = pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")


@deprecated
@pytest.mark.parametrize("part", COMPARISONS)
@pytest.mark.parametrize("name", ALL_ROBOTS)
def test_sample_differs_from_the_makers_class_exactly_as_ruled(name: str, part: str) -> None:
    compared = COMPARISONS[part](ALL_ROBOTS[name], EVERY[part])
    assert unruled(name, compared.found, compared.methods, part) == []
    # Some methods have no argument to draw.
    assert compared.compared > 0 or (part == "values" and compared.methods)


# The threads of the maker's classes end by SystemExit here; by themselves they never end.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
@deprecated
@pytest.mark.parametrize("name", SOCKETS)
def test_calls_over_tcp_differ_from_the_makers_class_only_as_ruled(name: str) -> None:
    compared = compare_sockets(ALL_ROBOTS[name], EVERY_BY_TCP)
    assert unruled(name, compared.found, (), "calls") == []
    assert compared.compared > 0


def test_every_ruling_has_a_reason_and_names_classes_and_methods_that_exist() -> None:
    for difference, reasons in rulings().items():
        for ruled in reasons:
            assert ruled.why
            assert "NO REASON" not in ruled.why
            classes = [library(each.partition(" ")[0]) for each in ruled.names]
            assert all(hasattr(each, difference.method) for each in classes)


@deprecated
@pytest.mark.parametrize("part", ["calls", "replies"])
def test_result_of_another_type_is_noticed(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def as_tuple(arm: Any) -> Any:
        return tuple(arm.arm.get_angles())

    monkeypatch.setattr(ours.MyCobot280, "get_angles", as_tuple)
    compared = COMPARISONS[part](ALL_ROBOTS["MyCobot280"], "get_angles")
    [text, *_] = unruled("MyCobot280", compared.found, compared.methods, part)
    assert "tuple of 6 float, not list of 6 float" in text


def test_value_that_only_one_side_sends_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def narrow(arm: Any, mode: int) -> Any:
        if mode == 1:
            raise UsageError("mode", mode, "0")
        return arm._order(arm.arm.set_fresh_mode, mode)

    monkeypatch.setattr(ours.MyCobot280, "set_fresh_mode", narrow)
    compared = COMPARISONS["values"](ALL_ROBOTS["MyCobot280"], "set_fresh_mode")
    assert unruled("MyCobot280", compared.found, compared.methods, "values") == [
        "no ruling: MyCobot280.set_fresh_mode, mode: only theirs: 1"
    ]


def test_ruling_that_no_longer_differs_is_noticed() -> None:
    left = unruled("MyCobot280", set(), {"set_server_port"}, "values")
    assert left
    assert all(text.startswith("no longer differs: MyCobot280.set_server_port") for text in left)


def test_each_call_of_the_makers_palletizer_fails_and_ours_succeeds() -> None:
    theirs = peer_on("MyPalletizer", RecordingPort())
    with pytest.raises(ValueError, match="too many values to unpack"):
        theirs.get_angles()
    calls = {call.method: call for call in calls_of(PALLETIZER) if not call.why}
    assert len(calls) >= 40
    results = {name: call_ours(PALLETIZER, call).result for name, call in calls.items()}
    rejected = {name for name, result in results.items() if str(result).startswith(FAILURES)}
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


@pytest.mark.parametrize("name", ["MyBuddy", "MyBuddySocket"])
def test_none_as_the_address_is_rejected_before_anything_is_sent(name: str) -> None:
    robot, methods = ALL_ROBOTS[name], set()
    for call in calls_of(robot):
        names = [*inspect.signature(getattr(library(name), call.method)).parameters][1:]
        at = next((n for n, each in enumerate(names) if each in ("id", "ids")), None)
        if at is not None and hasattr(getattr(ours, name), call.method):
            given = (*call.theirs[:at], None, *call.theirs[at + 1 :])
            assert call_ours(robot, call._replace(theirs=given)) == Called(b"", REJECTED), call
            methods.add(call.method)
    assert len(methods) > 60
