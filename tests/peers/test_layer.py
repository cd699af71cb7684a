"""Our classes with the maker's names, compared with the maker's classes."""

from __future__ import annotations

import inspect
import os
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cobotwire.pymycobot as ours
from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.layer.absent import why_absent
from cobotwire.pymycobot.layer.data import NAMES
from cobotwire.simulator import SimulatedArm, TcpServer
from differences import rulings, stale, unruled
from layer_comparison import (
    FAILED,
    REJECTED,
    Called,
    call_ours,
    call_theirs,
    layer_on,
    result_of_ours,
)
from layer_main import COMPARISONS
from layer_replies import compare_reply, drawn_reply
from layer_robots import ALL_ROBOTS, PALLETIZER, SOCKETS, TCP_TWINS
from layer_values import ONLY_OURS, ONLY_THEIRS, OTHER_BYTES
from pymycobot_classes import library, peer_on
from pymycobot_ports import RecordingPort, RecordingTransport
from robots.classes import ROBOTS
from robots.comparison import calls_of
from robots.robot import Call
from strategies import codec_of

CLASSES = sorted(NAMES)
# `make layer` compares all methods; here every n-th one.
EVERY = {"calls": 24, "values": 90, "replies": 40}
# A class that opens a TCP connection sends the same as the serial class of its robot.
SAMPLED = [name for name in ALL_ROBOTS if "EVERY_EDITION" in os.environ or name not in TCP_TWINS]
FEW = settings(max_examples=max(1, (settings.default or settings()).max_examples // 10))
FAILURES = (REJECTED, FAILED)
# By class and method, why our parameters differ.
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
        "ONE_WAY",
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


# pymycobot reads the locale in a way that Python deprecates.
deprecated = pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")


@deprecated
@pytest.mark.parametrize("part", COMPARISONS)
@pytest.mark.parametrize("name", SAMPLED)
def test_sample_differs_from_the_makers_class_exactly_as_ruled(name: str, part: str) -> None:
    compared = COMPARISONS[part](ALL_ROBOTS[name], EVERY[part])
    assert unruled(name, compared.found) == []
    assert stale(name, compared.found, {part: compared.methods}) == []
    # Some methods have no arguments.
    assert compared.compared > 0 or (part == "values" and compared.methods)


@deprecated
@FEW
@pytest.mark.parametrize("name", SAMPLED)
@given(data=st.data())
def test_drawn_reply_has_equal_results_or_its_method_has_a_ruling(
    name: str, data: st.DataObject
) -> None:
    robot = ALL_ROBOTS[name]
    codec = codec_of(robot.edition, "reference")
    call, reply = data.draw(drawn_reply(robot, codec))
    shows = compare_reply(robot, codec, call, reply)
    # Few drawn replies show how these two methods differ: test_layer_results.py covers
    # get_solution_angles; the library takes a Mercury's reply that begins with 255 for an
    # acknowledgement.
    ruled = {each for ruling in rulings() if name in ruling.names for each in ruling.methods}
    assert not shows or call.method in {*ruled, "get_servo_status", "get_solution_angles"}


@pytest.mark.parametrize("name", SOCKETS)
def test_class_opens_a_tcp_connection(name: str) -> None:
    robot = ALL_ROBOTS[name]
    given = (1,) if robot.table.addresses else ()
    call = Call("is_power_on", given, "is_power_on", given)
    with TcpServer(SimulatedArm(robot.table, powered=True).connect) as server:
        host, _, port = server.url.removeprefix("socket://").partition(":")
        arm = getattr(ours, name)(host, int(port))
        assert result_of_ours(arm, call) == call_theirs(robot, call).result == 1
        arm.arm.close()


def test_every_ruling_has_a_reason_and_names_classes_and_methods_that_exist() -> None:
    for ruling in rulings():
        assert ruling.why
        assert "NO REASON" not in ruling.why
        offered = [set(dir(library(each))) for each in ruling.names]
        assert ruling.methods <= set().union(*offered)
        assert all(each & ruling.methods for each in offered)
        # A ruling states which values ours sends, unless all its classes are additional ones.
        assert ruling.shows not in (ONLY_OURS, ONLY_THEIRS, OTHER_BYTES) or not (
            ruling.names & ROBOTS.keys()
        )


@deprecated
@pytest.mark.parametrize("part", ["calls", "replies"])
def test_result_of_another_type_is_noticed(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def as_tuple(arm: Any) -> Any:
        return tuple(arm.arm.get_angles())

    monkeypatch.setattr(ours.MyCobot280, "get_angles", as_tuple)
    compared = COMPARISONS[part](ALL_ROBOTS["MyCobot280"], "get_angles")
    assert "tuple of 6 float, not list of 6 float" in unruled("MyCobot280", compared.found)[-1]


def test_value_that_only_one_side_sends_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def narrow(arm: Any, mode: int) -> Any:
        if mode == 1:
            raise UsageError("mode", mode, "0")
        return arm._send_acked(arm.arm.set_fresh_mode, mode)

    monkeypatch.setattr(ours.MyCobot280, "set_fresh_mode", narrow)
    compared = COMPARISONS["values"](ALL_ROBOTS["MyCobot280"], "set_fresh_mode")
    assert unruled("MyCobot280", compared.found) == [
        "no ruling: MyCobot280.set_fresh_mode, mode: only theirs; ours sends 0..0"
    ]


def test_ruling_without_a_difference_is_noticed() -> None:
    left = stale("MyCobot280", set(), {"values": {"set_server_port"}})
    assert left
    assert all(text.startswith("no longer differs: MyCobot280.set_server_port") for text in left)


def test_each_call_of_the_makers_palletizer_fails_and_ours_succeeds() -> None:
    theirs = peer_on("MyPalletizer", RecordingPort())
    with pytest.raises(ValueError, match="too many values to unpack"):
        theirs.get_angles()
    calls = {call.method: call for call in calls_of(PALLETIZER)}
    assert len(calls) >= 40
    results = {name: call_ours(PALLETIZER, call).result for name, call in calls.items()}
    rejected = {name for name, result in results.items() if str(result).startswith(FAILURES)}
    # No source gives the geometry, so the simulated arm does not reply to the first call. The
    # second call lacks the mode that this class needs.
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


@pytest.mark.parametrize("name", [name for name in SAMPLED if name.startswith("MyBuddy")])
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
