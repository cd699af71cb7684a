"""Test the bytes of replies that have several legal variants."""

from __future__ import annotations

import pytest

from cobotwire import editions
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.arm import Note

POWER_ON, RELEASE_THE_THIRD = "FE FE 02 10 FA", "FE FE 03 56 03 FA"
ARE_ALL_ENABLED = "FE FE 02 51 FA"


def _reply(arm: SimulatedArm, *requests: str) -> str:
    """Send requests in hex; return all replies."""
    return arm.receive(bytes.fromhex("".join(requests))).hex(" ").upper()


def _with_one_flag() -> list[str]:
    """Return the editions without a check whose is_all_servo_enable reply is one flag."""
    tables = [editions.load(name).TABLE for name in editions.names()]
    return [
        table.edition
        for table in tables
        if table.frame.check is None
        and any(command.name == "is_all_servo_enable" for command in table.commands)
    ]


@pytest.mark.parametrize("edition", _with_one_flag())
def test_is_all_servo_enable_is_one_byte_that_is_1_when_all_are_on(edition: str) -> None:
    arm = SimulatedArm(editions.load(edition).TABLE, acks=False)
    assert _reply(arm, ARE_ALL_ENABLED) == "FE FE 03 51 00 FA"
    assert _reply(arm, POWER_ON, ARE_ALL_ENABLED) == "FE FE 03 51 01 FA"
    assert _reply(arm, RELEASE_THE_THIRD, ARE_ALL_ENABLED) == "FE FE 03 51 00 FA"


@pytest.mark.parametrize(
    ("words", "reply", "name", "why"),
    [
        ("FE FE 02 D4 FA", "FE FE 03 D4 01 FA", "move_round", "no source says"),
        ("FE FE 02 D7 FA", "FE FE 03 D7 01 FA", "set_four_pieces_zero", "four-piece motor"),
    ],
)
def test_command_without_effect_is_acknowledged_with_a_note(
    words: str, reply: str, name: str, why: str
) -> None:
    notes: list[Note] = []
    arm = SimulatedArm(editions.load("mycobot280").TABLE, powered=True, on_note=notes.append)
    assert _reply(arm, words) == reply
    [note] = notes
    assert note.command == name
    assert why in note.text
