"""Statements are read from YAML; every mistake is named with its place."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import editions
from cobotwire.conformance.device import RunOptions
from cobotwire.conformance.statement import (
    Acknowledgements,
    Support,
    load_statement,
    read_statement,
    statement_template,
    with_deadlines,
)
from cobotwire.protocol.errors import StatementError, UsageError

TABLE = editions.load("mycobot280").TABLE
HEAD = "statement: 1\nedition: mycobot280\n"


@pytest.mark.parametrize("edition", editions.names())
def test_template_of_an_edition_is_a_statement_that_declares_everything(edition: str) -> None:
    table = editions.load(edition).TABLE
    found = read_statement(statement_template(table), table)
    names = {command.name for command in table.commands if not command.event}
    assert set(found.commands) == names
    assert set(found.commands.values()) == {Support.IMPLEMENTED}
    assert not list(found.absent(table))
    assert all(found.fitted.values())


def test_statement_holds_what_its_file_declares(tmp_path: Path) -> None:
    path = tmp_path / "arm.yaml"
    path.write_text(
        HEAD + "maker: Some Maker\nfirmware: '6.5'\nacknowledgements: none\n"
        "fitted: {gripper: false}\ncommands: {get_tof_distance: absent, set_color: optional}\n"
    )
    found = load_statement(path, TABLE)
    assert (found.maker, found.firmware) == ("Some Maker", "6.5")
    assert found.acknowledgements is Acknowledgements.NONE
    assert [command.name for command in found.absent(TABLE)] == ["get_tof_distance"]
    assert found.optional == {"set_color"}
    assert "gripper" in found.deselected(TABLE.command("get_gripper_value"))
    assert "absent" in found.deselected(TABLE.command("get_tof_distance"))
    assert found.deselected(TABLE.command("get_angles")) == ""
    assert found.text == path.read_text()


def test_extra_information_completes_the_options_of_a_run() -> None:
    text = HEAD + "ixit: {linger: 6, workspace: '-9:9', max_speed: 20, deadlines: {get_angles: 80}}"
    found = read_statement(text, TABLE)
    options = RunOptions(workspace="-5:5").completed(found.ixit)
    assert (options.linger, options.workspace, options.max_speed) == (6, "-5:5", 20)
    table = with_deadlines(TABLE, found.deadlines)
    changed = [(a.name, b.deadline_ms) for a, b in zip(TABLE.commands, table.commands) if a != b]
    assert changed == [("get_angles", 80)]


# A statement, and what the error says.
MISTAKES = {
    "unknown command": (
        HEAD + "commands:\n  get_tof_distanse: absent\n",
        "arm.yaml:4:3: commands has no key get_tof_distanse; did you mean get_tof_distance?",
    ),
    "unknown key": (
        HEAD + "comands: {}\n",
        "arm.yaml:3:1: a statement has no key comands; did you",
    ),
    "unknown support": (
        HEAD + "commands:\n  set_color: abscent\n",
        "arm.yaml:4:14: set_color is abscent; allowed: implemented, optional, absent; did you mean",
    ),
    "mandatory": (
        HEAD + "commands:\n  get_angles: absent\n",
        "arm.yaml:4:15: get_angles is absent, but every arm must have it (its role: joints)",
    ),
    "mandatory as optional": (HEAD + "commands: {stop: optional}", "stop is optional, but every"),
    "other edition": (
        "statement: 1\nedition: mycobot\n",
        "arm.yaml:2:10: edition is mycobot; allowed: mycobot280",
    ),
    "no edition": ("statement: 1\n", "arm.yaml:1:1: the key edition is missing"),
    "later version": ("statement: 2\nedition: mycobot280\n", "statement is 2; allowed: 1"),
    "no version": ("statement: true\nedition: mycobot280\n", "statement is true; allowed: 1"),
    "family": (
        HEAD + "fitted: {griper: true}",
        "arm.yaml:3:10: fitted has no key griper; did you mean gripper?",
    ),
    "flag": (HEAD + "fitted: {gripper: 1}", "arm.yaml:3:19: gripper is 1; allowed: true, false"),
    "number as text": (
        HEAD + "firmware: 1.0",
        "arm.yaml:3:11: firmware is 1.0; allowed: text, in quotes",
    ),
    "no workspace": (
        HEAD + "ixit: {workspace: '9'}",
        "arm.yaml:3:19: workspace is 9; allowed: LOW",
    ),
    "linger": (HEAD + "ixit: {linger: -1}", "linger is -1; allowed: 0..60000 milliseconds"),
    "speed": (HEAD + "ixit: {max_speed: true}", "max_speed is true; allowed: 1..100 percent"),
    "address": (HEAD + "ixit: {address: LEFT}", "address is LEFT; edition mycobot280 has no"),
    "deadline": (
        HEAD + "ixit: {deadlines: {get_angles: 501}}",
        "arm.yaml:3:32: get_angles is 501; allowed: 1..500 milliseconds",
    ),
    "deadline of a one-way request": (
        HEAD + "ixit: {deadlines: {stop: 1}}",
        "deadlines has no key",
    ),
    "no content": (
        "# later",
        "arm.yaml:1:1: the file has no content; a statement is a YAML mapping",
    ),
    "list": ("[1]", "arm.yaml:1:1: a statement is a list; allowed: a mapping"),
    "key twice": (
        HEAD + "maker: a\nmaker: b\n",
        "arm.yaml:4:1: the key maker is already in line 3",
    ),
    "no YAML": ("{", "arm.yaml:"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistake_is_named_with_its_place_and_the_nearest_word(mistake: str) -> None:
    text, expected = MISTAKES[mistake]
    with pytest.raises(StatementError) as caught:
        read_statement(text, TABLE, "arm.yaml")
    assert expected in str(caught.value)


def test_all_mistakes_are_named_at_once() -> None:
    text = HEAD + "maker: 1\ncommands: {get_angle: absent, stop: absent}\n"
    with pytest.raises(StatementError) as caught:
        read_statement(text, TABLE)
    assert len(caught.value.problems) == 3


def test_missing_file_is_named() -> None:
    with pytest.raises(UsageError, match=r"nowhere\.yaml: No such file"):
        load_statement("nowhere.yaml", TABLE)


VALUES = st.recursive(
    st.sampled_from(["absent", "true", "1", "null", "'x'", "mycobot280", "!!python/none", "&a b"]),
    lambda inner: (
        st.lists(inner, max_size=3).map(lambda xs: f"[{', '.join(xs)}]")
        | st.dictionaries(
            st.sampled_from(
                ["stop", "gripper", "get_angles", "a b", "deadlines", "address", "workspace"]
            ),
            inner,
            max_size=3,
        ).map(lambda d: "{" + ", ".join(f"{k}: {v}" for k, v in d.items()) + "}")
    ),
    max_leaves=8,
)
KEYS = st.sampled_from(
    ["maker", "firmware", "acknowledgements", "fitted", "commands", "edition", "ixit"]
)


@given(
    st.text(max_size=40)
    | st.dictionaries(KEYS, VALUES, max_size=4).map(
        lambda d: "statement: 1\n" + "".join(f"{k}: {v}\n" for k, v in d.items())
    )
)
def test_any_text_is_a_statement_or_an_error_that_names_places(text: str) -> None:
    with contextlib.suppress(StatementError):
        assert read_statement(text, TABLE, "arm.yaml").edition == "mycobot280"
        return
    with pytest.raises(StatementError) as caught:
        read_statement(text, TABLE, "arm.yaml")
    problems = caught.value.problems
    assert problems
    assert all(problem.startswith("arm.yaml:") for problem in problems)
