"""All subcommands use the same words for the port, for the edition and for JSON output."""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterator

import click
import pytest

from cobotwire.cli.app import app
from in_process import cobotwire


def subcommands(group: click.Group = app, *names: str) -> Iterator[tuple[str, click.Command]]:
    """Yield each subcommand of the command line with its name."""
    context = click.Context(group)
    for name in group.list_commands(context):
        subcommand = group.get_command(context, name)
        assert subcommand is not None
        if isinstance(subcommand, click.Group):
            yield from subcommands(subcommand, *names, name)
        else:
            yield " ".join([*names, name]), subcommand


SUBCOMMANDS = dict(subcommands())


def test_subcommands_that_open_a_port_take_it_as_their_first_argument_url() -> None:
    taking = set()
    for name, subcommand in SUBCOMMANDS.items():
        arguments = [p for p in subcommand.params if isinstance(p, click.Argument)]
        taking |= {name for p in arguments[:1] if p.name == "port" and p.metavar == "URL"}
        assert not [p for p in arguments[1:] if p.name == "port"], name
        assert not [p for p in subcommand.params if {"--port", "--url"} & {*p.opts}], name
    assert {"call", "doctor", "monitor", "conform device"} <= taking


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_json_option_needs_no_value(name: str) -> None:
    for option in SUBCOMMANDS[name].params:
        if "--json" in option.opts:
            assert isinstance(option, click.Option)
            assert option.is_flag or option.flag_value == "-"
        assert not {"--format", "-j"} & {*option.opts}


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_only_subcommands_that_use_the_edition_have_the_option(name: str) -> None:
    callback = SUBCOMMANDS[name].callback
    assert callback is not None
    takes = any("--edition" in option.opts for option in SUBCOMMANDS[name].params)
    assert takes == ("edition" in inspect.signature(callback).parameters)


@pytest.mark.parametrize("words", ["{0} conform statement", "conform {0} statement {0}"])
def test_edition_is_given_before_or_after_the_subcommand(words: str) -> None:
    assert "edition: mycobot\n" in cobotwire(*words.format("--edition mycobot").split()).stdout


@pytest.mark.parametrize(
    ("words", "code", "stderr"),
    [
        ("--edition mycobot commands --edition pro400", 2, "given twice: mycobot and pro400"),
        ("commands --edition mycobot --edition pro400", 2, "given twice: mycobot and pro400"),
        ("--edition mycobot conform cases", 0, "cobotwire: cases does not use --edition\n"),
        ("conform cases --edition mycobot", 2, "No such option"),
        ("monitr", 2, "there is no subcommand 'monitr'; did you mean monitor?"),
        ("call /dev/x send_angles 0,0,0,0,0,0 --speed 3", 2, "is written as speed=VALUE"),
        ("call /dev/x go_hom", 2, "did you mean go_home?"),
        ("commands --edition 280", 2, "; did you mean mycobot280?"),
        ("migrate tests", 2, "tests is a folder; name the programs in it"),
        ("migrate no_such.py", 2, "no_such.py: No such file"),
        ("run tests", 2, "tests: is a folder; name a program in it"),
        ("run --eror raise x.py", 2, "--errors"),
    ],
)
def test_misused_words_are_explained(words: str, code: int, stderr: str) -> None:
    result = cobotwire(*words.split())
    assert (result.returncode, stderr in result.stderr) == (code, True), result.stderr


def test_json_option_of_conform_prints_the_report() -> None:
    result = cobotwire("conform", "device", "--simulated", "--json")
    assert json.loads(result.stdout)["edition"]
    assert "pass" in result.stderr
