"""Errors of the layer use the library's parameter names, which the caller wrote."""

from __future__ import annotations

import re
from typing import Any

import pytest

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.migrate.calls import library
from layer.arms import made


@pytest.mark.parametrize(
    ("name", "method", "arguments", "text"),
    [
        ("MyCobot280", "send_angle", (1, 200, 50), "degree is 200"),
        ("MyCobot280", "send_angle", (9, 20, 50), "id is 9"),
        ("MyCobot280", "send_angles", ([0] * 5, 50), "len(angles) is 5"),
        ("MyCobot280", "set_encoders", ([0] * 6, 200), "sp is 200"),
        ("MyCobot280", "sync_send_angles", ([0] * 5, 50), "len(degrees) is 5"),
        ("MyCobot280", "sync_send_angles", ([200] + [0] * 5, 50), "degrees.j1 is 200"),
        ("MyCobot280", "is_in_position", ([0] * 5, 0), "len(data) is 5"),
        ("MyCobot280", "set_color", (300, 0, 0), "r is 300"),
        ("MyCobot280", "set_ssid_pwd", ("é", "c"), "account is 'é'"),
        ("Mercury", "set_pro_gripper_angle", (300,), "gripper_angle is 300"),
        ("Mercury", "set_hand_gripper_p", (9, 5), "hand_id is 9"),
        ("Mercury", "set_hand_gripper_pinch_action_speed_consort", (7, 0), "pinch_pose is 7"),
        ("Mercury", "is_in_position", ([0] * 5,), "len(data) is 5"),
        ("Mercury", "is_in_position", ([0] * 7, 3), "mode is 3"),
        ("Mercury", "get_coords", ([0] * 5,), "len(angles) is 5"),
        ("Pro450Client", "set_pro_gripper_angle", (101,), "gripper_angle is 101"),
        ("Pro450Client", "get_pro_gripper_angle", (0,), "gripper_id is 0"),
        ("Pro450Client", "base_external_can_control", (0, [1]), "can_id is 0"),
        ("Pro450Client", "set_limit_switch", (3, 1), "limit_mode is 3"),
        ("Mercury", "set_limit_switch", (3, 1), "limit_mode is 3"),
        ("Mercury", "set_limit_switch", (1, 2), "state is 2"),
        ("Pro630", "set_basic_output", (7, 1), "pin_no is 7"),
        *(("Pro630", "power_on", (delay,), f"delay is {delay!r}") for delay in (None, "2", -1)),
    ],
)
def test_error_names_what_the_caller_wrote(
    name: str, method: str, arguments: tuple[Any, ...], text: str
) -> None:
    with pytest.raises(UsageError) as raised:
        getattr(made(name)[0], method)(*arguments)
    assert str(raised.value).startswith(f"{text}; allowed: ")
    assert raised.value.argument == text.partition(" is ")[0]


@pytest.mark.parametrize("name", sorted(library()))
def test_every_method_names_its_own_parameters(name: str) -> None:
    arm, checked = made(name)[0], 0
    for method, call in library()[name].methods.items():
        given = [each for each in call.parameters if each != "_async"]
        if not given or method.startswith("sync_"):
            continue
        with pytest.raises(UsageError) as raised:
            getattr(arm, method)(*[object()] * len(given))
        names = re.sub(r"^len\((.*)\)$", r"\1", raised.value.argument).split(", ")
        assert {re.split(r"[.\[]", each)[0] for each in names} <= set(given), method
        checked += 1
    assert checked > 10


def test_text_without_the_argument_is_not_renamed() -> None:
    error = UsageError("servo", 3, message="the arm has no servo 3")
    assert str(error.renamed({"servo": "servo_id"})) == "the arm has no servo 3"
    assert error.renamed({"servo": "servo_id"}).argument == "servo_id"
