"""Check that the docs name only options of the command line that exist."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from cobotwire.cli.app import app
from vectors import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def _options_of(command: click.Command, name: str) -> Iterator[tuple[str, set[str]]]:
    given = [
        word for each in command.params if isinstance(each, click.Option) for word in each.opts
    ]
    yield name, {*given, "--help"}
    if isinstance(command, click.Group):
        context = click.Context(command)
        for word in command.list_commands(context):
            subcommand = command.get_command(context, word)
            assert subcommand is not None
            yield from _options_of(subcommand, f"{name} {word}")


OPTIONS = dict(_options_of(app, "cobotwire"))


def unknown_options(text: str) -> list[str]:
    """Return the options in calls of cobotwire that neither subcommand nor program has."""
    found = []
    for call in re.finditer(r"(?<!=)\bcobotwire ([^`|#\n]+)", text):
        words = call[1].split(" -- ")[0].split()
        subcommand = "cobotwire"
        for word in words:
            subcommand = f"{subcommand} {word}" if f"{subcommand} {word}" in OPTIONS else subcommand
        known = {
            option for name in OPTIONS if subcommand.startswith(name) for option in OPTIONS[name]
        }
        options = [match[0] for word in words if (match := re.match(r"--[a-z][a-z-]*", word))]
        found += [f"{subcommand} {option}" for option in options if option not in known]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_page_names_only_options_that_exist(page: Path) -> None:
    assert unknown_options(page.read_text(encoding="utf-8")) == []


def test_option_that_does_not_exist_is_found() -> None:
    text = "`cobotwire conform device /dev/x --jsn a` and cobotwire --edition x sim --tcp :0 --up"
    assert unknown_options(text) == ["cobotwire conform device --jsn", "cobotwire sim --up"]
