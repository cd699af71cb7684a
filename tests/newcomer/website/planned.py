"""Say for each command and Python program of a page what it prints, or why it is not run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from newcomer.website.blocks import commands, console, programs

ANY = -1


class Expected(NamedTuple):
    """What a command prints, as a regular expression that the output contains, and how it ends."""

    output: str = ""
    code: int = 0
    # Whether the command runs until Ctrl-C, which follows the expected output.
    served: bool = False
    shell: str = "bash"
    # What the shell runs first.
    before: str = ""


class NotRun(NamedTuple):
    """A command or a program that this machine cannot run."""

    reason: str


class Program(NamedTuple):
    """What a Python block needs before it, and a regular expression that its output contains."""

    setup: str = ""
    output: str = ""


class Plan(NamedTuple):
    """How a page is run.

    Attributes:
        commands: By the command as the page shows it, without its comment.
        programs: By their first line. Others are run as they are.
        prepare: Shell commands that make the files which the page reads.
        unlike: Commands of ``console`` blocks that are not run.
    """

    commands: Mapping[str, Expected | NotRun] = {}
    programs: Mapping[str, Program | NotRun] = {}
    prepare: str = ""
    unlike: Mapping[str, NotRun] = {}


INSTALLED = Expected(r"Requirement already satisfied: cobotwire")


def unplanned(page: str, plan: Plan) -> list[str]:
    """Return the commands that only the page has, and those that only its plan has."""
    shown = list(commands(page))
    first = [block.text.partition("\n")[0] for block in programs(page)]
    stale = [
        *(line for line in plan.commands if line not in shown),
        *(line for line in plan.programs if line not in first),
        *(line for line in plan.unlike if line not in list(console(page))),
    ]
    lacking = [line for line in shown if line not in plan.commands]
    return [f"no plan: {line}" for line in lacking] + [f"not on the page: {line}" for line in stale]
