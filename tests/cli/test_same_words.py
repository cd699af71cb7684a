"""Check that all verbs name a port in one way, and ask for JSON in one way."""

from __future__ import annotations

import json
from collections.abc import Iterator

import click
import pytest

from cobotwire.cli.app import app
from cobotwire.simulator import PtyServer
from in_process import cobotwire


def verbs(group: click.Group = app, *names: str) -> Iterator[tuple[str, click.Command]]:
    """Yield each verb of the command line with its name."""
    context = click.Context(group)
    for name in group.list_commands(context):
        verb = group.get_command(context, name)
        assert verb is not None
        if isinstance(verb, click.Group):
            yield from verbs(verb, *names, name)
        else:
            yield " ".join([*names, name]), verb


VERBS = dict(verbs())


def test_verbs_that_open_a_port_take_it_as_their_first_argument_url() -> None:
    taking = set()
    for name, verb in VERBS.items():
        arguments = [p for p in verb.params if isinstance(p, click.Argument)]
        taking |= {name for p in arguments[:1] if p.name == "port" and p.metavar == "URL"}
        assert not [p for p in arguments[1:] if p.name == "port"], name
        assert not [p for p in verb.params if {"--port", "--url"} & {*p.opts}], name
    assert {"call", "doctor", "monitor", "conform device"} <= taking


@pytest.mark.parametrize("name", VERBS)
def test_json_option_needs_no_value(name: str) -> None:
    for option in VERBS[name].params:
        if "--json" in option.opts:
            assert isinstance(option, click.Option)
            assert option.is_flag or option.flag_value == "-"
        assert not {"--format", "-j"} & {*option.opts}


def test_port_comes_before_the_command(server: PtyServer) -> None:
    result = cobotwire("call", server.url, "is_power_on", "--json")
    assert json.loads(result.stdout) == {"command": "is_power_on", "result": False}


def test_json_option_of_conform_prints_the_report() -> None:
    result = cobotwire("conform", "device", "--simulated", "--json")
    assert json.loads(result.stdout)["edition"]
    assert "pass" in result.stderr
