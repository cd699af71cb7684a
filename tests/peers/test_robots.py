"""A sample of ``make robots``, and requests of drawn values."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from differences import rulings
from pymycobot_classes import library
from robots.classes import ROBOTS
from robots.comparison import OPEN, REJECTED, compare, difference
from robots.drawing import drawn_call
from robots.robot import SERVO_BUS, Ruling

# `make robots` compares every method; these tests compare every STRIDE-th.
STRIDE = 6

# There are many classes.
FEW = settings(max_examples=max(1, (settings.default or settings()).max_examples // 5))
# Their scale is disputed: the class for the 280 sends other steps than the document's edition.
DISPUTED = {"set_joint_max", "set_joint_min", "set_tool_reference", "set_world_reference"}

robots = pytest.mark.parametrize("peer", ROBOTS)


@robots
def test_requests_equal_those_of_the_makers_class_or_have_a_ruling(peer: str) -> None:
    robot = ROBOTS[peer]
    methods = robot.public[len(peer) % STRIDE :: STRIDE]
    found = compare(robot, methods)
    assert [each for each in found if each.open] == []
    assert sum(each.equal for each in found) > len(methods)


@FEW
@robots
@given(data=st.data())
def test_drawn_request_equals_that_of_the_makers_class_or_has_a_ruling(
    peer: str, data: st.DataObject
) -> None:
    why = difference(ROBOTS[peer], data.draw(drawn_call(ROBOTS[peer])))
    assert why is None or not why.startswith(OPEN)


@FEW
@robots
@given(data=st.data())
def test_number_that_the_library_states_is_sent_by_both_or_only_one_side_by_a_ruling(
    peer: str, data: st.DataObject
) -> None:
    call = data.draw(drawn_call(ROBOTS[peer], stated_by_maker=True))
    why = difference(ROBOTS[peer], call) or ""
    if f"; ours: {REJECTED}" in why:
        # `make layer` compares which numbers both sides reject, but not with this edition.
        both = why.count(REJECTED) > 1
        assert both or peer == "MyCobot" or call.method in _rejecting(peer), why
    else:
        assert not why.startswith(OPEN)


def _rejecting(peer: str) -> set[str]:
    """Return the methods of a class that send what ours reject."""
    return {method for ruling in rulings() if peer in ruling.names for method in ruling.methods}


def test_requests_of_the_document_that_its_class_lacks_equal_those_of_newer_classes() -> None:
    equal = set()
    for peer in ("MyCobot280", "MyPalletizer260"):
        newer = replace(ROBOTS[peer], edition="mycobot", calls=())
        found = compare(newer, ROBOTS["MyCobot"].lacking)
        # The palletizer has no joint 6.
        whole = (each for each in found if not each.open or each.method == "jog_absolute")
        equal |= {each.method for each in whole if each.equal}
    assert equal == set(ROBOTS["MyCobot"].lacking) - DISPUTED


@robots
def test_every_command_has_a_method_of_the_makers_class_or_a_reason(peer: str) -> None:
    robot = ROBOTS[peer]
    commands = [command for command in robot.table.commands if not command.event]
    without = {c.name for c in commands if not hasattr(library(peer), robot.method(c))}
    assert set(robot.not_ours) <= set(robot.public)
    assert without == set(robot.lacking)
    assert all(robot.lacking.values())


@robots
def test_what_is_stated_about_a_class_names_its_methods_and_gives_reasons(peer: str) -> None:
    robot = ROBOTS[peer]
    for method, stated in robot.rulings.items():
        assert method in robot.public
        assert all(ruling.why for ruling in stated)
    names = {name for name in dir(library(peer)) if not name.startswith("_")}
    assert robot.local - SERVO_BUS <= names


def test_another_edition_is_noticed() -> None:
    other = replace(ROBOTS["MechArm270"], edition="mypalletizer260")
    found = {each.method: each.open for each in compare(other, ["send_angles", "set_color"])}
    assert "ours: fe fe 0b 22" in found["send_angles"][0]
    assert found["set_color"] == ()


def test_ruling_without_a_differing_call_is_reported() -> None:
    stale = {"set_color": [Ruling("fe fe", "a reason")]}
    [found] = compare(replace(ROBOTS["MechArm270"], rulings=stale), ["set_color"])
    assert found.open == ("no call needs the ruling: a reason",)
    [found] = compare(replace(ROBOTS["MyCobot"], rulings={}), ["set_server_port"])
    assert "'h' format" in found.open[0]
