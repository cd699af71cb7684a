"""The numbers and words of docs/robots.md agree with the editions."""

from __future__ import annotations

import re
from pathlib import Path

from cobotwire.editions import load, names

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "robots.md").read_text()


def rows(heading: str) -> list[list[str]]:
    """Return the cells of the table with this heading."""
    start = PAGE.index(heading)
    lines = PAGE[start:].split("\n\n", 1)[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_every_edition_has_a_row_with_its_page_class_and_commands() -> None:
    found = {
        re.findall(r"/robots/(\w+)\.html", cells[0])[0]: tuple(cells[1:])
        for cells in rows("| robot | edition, class |")
    }
    wanted = {
        name: (f"`{name}`, `{load(name).CLIENT.__name__}`", str(len(load(name).TABLE.commands)))
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
