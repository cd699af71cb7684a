"""A delta withdraws or replaces the acknowledgements of its base."""

from __future__ import annotations

import pytest

from cobotwire_codegen.check import check
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition
from codegen.test_inherited_vectors import HEAD, WHY
from codegen.test_inherited_vectors import built as build_delta


def built(text: str = "") -> Edition:
    edition = build_delta(text)
    check(edition)
    return edition


def acknowledged(edition: Edition) -> set[str]:
    return {command.name for command in edition.commands if command.ack}


def test_withdrawn_acks_leave_setters_without_replies_and_reply_vectors() -> None:
    base = built()
    delta = built(f"changes:\n  - withdraw_acks: all\n    {WHY}")
    assert acknowledged(base)
    assert not acknowledged(delta)
    silent = {command.name for command in delta.commands if not command.replies}
    assert acknowledged(base) <= silent
    gone = {v.name for v in base.vectors} - {v.name for v in delta.vectors}
    assert gone == {
        v.name for v in base.vectors if v.command in acknowledged(base) and v.direction == "reply"
    }


def test_ack_of_one_command_is_withdrawn_also_after_a_rename() -> None:
    changes = f"""\
changes:
  - withdraw_acks: [power_on, power_off]
    {WHY}\
  - rename: power_off
    to: switch_off
    {WHY}"""
    base, delta = built(), built(changes)
    assert acknowledged(base) - acknowledged(delta) == {"power_on", "power_off"}
    assert "switch_off" not in acknowledged(delta)


def test_acks_of_a_delta_replace_those_of_its_base() -> None:
    changes = f"changes:\n  - withdraw_acks: [power_on]\n    {WHY}"
    acks = "acks:\n  field: {name: done, type: acknowledgement}\n  why: A trial.\n"
    acks += "  except: [set_ssid_pwd, jog_stop, power_off]\n"
    base, delta = built(), built(changes + acks)
    assert acknowledged(base) - acknowledged(delta) == {"power_off"}


def test_removed_command_may_be_an_exception_of_the_base() -> None:
    built(f"changes:\n  - remove: set_ssid_pwd\n    {WHY}")


def test_withdrawn_ack_of_unknown_command_is_reported() -> None:
    with pytest.raises(SpecError, match="there is no command power_onn; did you mean power_on"):
        built(f"changes:\n  - withdraw_acks: [power_onn]\n    {WHY}")


def test_acks_that_the_base_lacks_cannot_be_withdrawn() -> None:
    with pytest.raises(SpecError, match="the base has no acks to withdraw"):
        build_delta(
            f"changes:\n  - withdraw_acks: all\n    {WHY}", HEAD.replace("mycobot280", "mycobot")
        )
