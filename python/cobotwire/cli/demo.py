"""``cobotwire demo``: the whole way, on this machine, without an arm."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import click
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

from cobotwire import codec as codecs
from cobotwire.demo import Result, run
from cobotwire.driver import Traffic
from cobotwire.editions.mycobot import TABLE
from cobotwire.explain import DIRECTIONS, explain, summary
from cobotwire.table import Command

# So many exchanges of a kind are shown before the rest of the polling is left out.
SHOWN_FIRST = 2


@click.command()
@click.option("--codec", type=click.Choice(["native", "reference"]), help="Force one codec.")
def demo(codec: codecs.CodecName | None) -> None:
    """Drive a simulated arm over a pseudo-terminal and check every answer."""
    console = Console(highlight=False)
    columns = (TextColumn("  moving"), BarColumn(), TaskProgressColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as bar:
        task = bar.add_task("moving", total=1.0)
        # Where there is no terminal, a line for each quarter takes the place of the bar.
        quarters = iter((0.25, 0.5, 0.75, 1.0))
        due = next(quarters)

        def progress(share: float) -> None:
            nonlocal due
            bar.update(task, completed=share)
            while share >= due and not console.is_terminal:
                console.print(f"  moving: {due:.0%}")
                due = next(quarters, 2.0)

        result = run(
            lambda line: console.print(f"- {line}", soft_wrap=True, markup=False), progress, codec
        )
    _show_traffic(console, result.traffic)
    _show_checks(console, result)
    sys.exit(0 if result.passed else 1)


def _show_traffic(console: Console, traffic: tuple[Traffic, ...]) -> None:
    console.print("\nOver the line (seconds, direction, bytes, meaning):", style="bold")
    start = traffic[0].time
    hidden = 0
    lines = list(_lines(traffic))
    for line, shown in zip(lines, _worth_showing(lines)):
        if not shown:
            hidden += 1
            continue
        if hidden:
            console.print(f"          ... {hidden} more like these")
            hidden = 0
        data = f"{line.data.hex(' ').upper()}  {line.meaning}"
        console.print(f"{line.time - start:7.3f} {line.arrow} {data}", soft_wrap=True, markup=False)


class _Line(NamedTuple):
    time: float
    arrow: str
    data: bytes
    command: Command | None
    meaning: str


def _lines(traffic: tuple[Traffic, ...]) -> Iterator[_Line]:
    codec = codecs.load(TABLE)
    for one in traffic:
        arrow, way = (">", DIRECTIONS[:1]) if one.direction == "sent" else ("<", DIRECTIONS[1:])
        for explained in explain(codec, one.data, way):
            messages = [r.message for r in explained.readings if r.message is not None]
            command = messages[0].command if messages else None
            meaning = summary(messages[0]) if messages else "noise"
            yield _Line(one.time, arrow, explained.event.data, command, meaning)


def _worth_showing(lines: Sequence[_Line]) -> list[bool]:
    """Of the polling between two orders, the first and last exchange of each kind."""
    shown = [False] * len(lines)
    kinds: dict[tuple[str, Command | None], list[int]] = {}
    for index, line in enumerate(lines):
        if line.command is None or line.command.safety != "query":
            kinds.clear()
        seen = kinds.setdefault((line.arrow, line.command), [])
        seen.append(index)
        shown[index] = True
        if len(seen) > SHOWN_FIRST + 1:
            shown[seen[-2]] = False
    return shown


def _show_checks(console: Console, result: Result) -> None:
    console.print("\nAnswers:", style="bold")
    for check in result.checks:
        style, verdict = ("green", "right") if check.passed else ("red", "WRONG")
        expected = "" if check.passed else f", expected {check.right}"
        said = escape(f"{check.what}: {check.got}{expected}")
        console.print(f"  [{style}]{verdict}[/{style}]  {said}", soft_wrap=True)
    right = sum(check.passed for check in result.checks)
    console.print(f"{right} of {len(result.checks)} answers right", style="bold")
