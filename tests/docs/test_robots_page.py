"""The numbers and words of docs/robots.md agree with the editions and the maker's classes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cobotwire.editions import load, names
from robots.classes import ROBOTS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "robots.md").read_text()


def rows(heading: str) -> list[list[str]]:
    """Return the cells of the table with this heading."""
    start = PAGE.index(heading)
    lines = PAGE[start:].split("\n\n", 1)[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def stated_as(edition: str) -> str:
    spec = (ROOT / "spec" / "editions" / f"{edition}.yaml").read_text()
    base = re.search(r"^base: (\w+)\.yaml$", spec, re.MULTILINE)
    return f"a delta over `{base[1]}`" if base else "a whole edition"


def test_every_edition_has_a_row_with_its_class_commands_and_base() -> None:
    found = {
        re.findall(r"`(\w+)`", cells[1])[0]: (re.findall(r"`(\w+)`", cells[1])[1], *cells[2:])
        for cells in rows("| robot | edition, class |")
    }
    wanted = {
        name: (load(name).CLIENT.__name__, str(len(load(name).TABLE.commands)), stated_as(name))
        for name in names()
    }
    assert found == wanted


def test_geometry_is_unknown_where_the_edition_has_none() -> None:
    found = {
        name: cells[3] == "unknown"
        for cells in rows("| edition | messages |")
        for name in re.findall(r"`(\w+)`", cells[0])
    }
    assert found == {name: load(name).TABLE.robot.geometry is None for name in names()}


@pytest.mark.parametrize("peer", ROBOTS)
def test_every_class_has_a_row_of_agreement(peer: str) -> None:
    # `make robots` compares all calls, and fails if another number of this table is not true.
    [row] = [cells for cells in rows("| class | edition | methods |") if cells[0] == peer]
    robot, (edition, *counts) = ROBOTS[peer], row[1:]
    methods, equal, ruled, opened = map(int, counts)
    assert (edition.strip("`"), methods, opened) == (robot.edition, len(robot.public), 0)
    assert equal + ruled == methods
