"""Errors of the layer name the library's parameters: what the caller wrote."""

from __future__ import annotations

import re
from typing import Any

import pytest

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.migrate.calls import library
from layer.arms import made


@pytest.mark.parametrize(
    ("method", "arguments", "text"),
    [
        ("send_angle", (1, 200, 50), "degree is 200; allowed: "),
        ("send_angle", (9, 20, 50), "id is 9; allowed: "),
        ("send_angles", ([0] * 5, 50), "len(angles) is 5; allowed: "),
        ("set_encoders", ([0] * 6, 200), "sp is 200; allowed: "),
        ("sync_send_angles", ([0] * 5, 50), "len(degrees) is 5; allowed: "),
        ("sync_send_angles", ([200] + [0] * 5, 50), "degrees.j1 is 200; allowed: "),
        ("is_in_position", ([0] * 5, 0), "len(data) is 5; allowed: "),
        ("set_color", (300, 0, 0), "r is 300; allowed: "),
        ("set_ssid_pwd", ("é", "c"), "account is "),
    ],
)
def test_error_names_what_the_caller_wrote(
    method: str, arguments: tuple[Any, ...], text: str
) -> None:
    with pytest.raises(UsageError) as raised:
        getattr(made("MyCobot280")[0], method)(*arguments)
    assert str(raised.value).startswith(text)
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
