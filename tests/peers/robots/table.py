"""Count what the comparison of a class showed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from robots.comparison import Compared
from robots.robot import Robot

HEADING = "| class | edition | methods | equal | ruled | open |\n|---|---|--:|--:|--:|--:|"


class Counts(NamedTuple):
    """The methods of a class: all calls equal, some ruled, some open."""

    methods: int
    equal: int
    ruled: int
    open: int


def counts_of(found: Sequence[Compared]) -> Counts:
    """Return the counts of a class; each method counts once."""
    opened = sum(1 for each in found if each.open)
    ruled = sum(1 for each in found if each.ruled and not each.open)
    return Counts(len(found), len(found) - ruled - opened, ruled, opened)


def row_of(robot: Robot, found: Sequence[Compared]) -> str:
    """Return the row of a class in the table."""
    return f"| {robot.peer} | `{robot.edition}` | " + " | ".join(map(str, counts_of(found))) + " |"
