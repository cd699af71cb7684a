"""``cobotwire demo``: drive a simulated arm, and check every reply."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import click
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

from cobotwire import codec as codecs
from cobotwire.cli.shared.output import as_hex, fold
from cobotwire.cli.shared.recordings import ARROWS
from cobotwire.client import Traffic
from cobotwire.diagnose.explain import DIRECTIONS, FrameReader, Reading, format_message
from cobotwire.editions.mycobot import TABLE
from cobotwire.inspect.demo import Result, run

# Polling repeats the same messages: only this many of each kind, and the last one, are shown.
SHOWN_FIRST = 2


@click.command()
@click.option("--codec", type=click.Choice(["native", "reference"]), help="The client's codec.")
def demo(codec: codecs.CodecName | None) -> None:
    """Drive a simulated arm over a pseudo-terminal, and check every reply."""
    console = Console(highlight=False)
    columns = (TextColumn("  moving"), BarColumn(), TaskProgressColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as bar:
        task = bar.add_task("moving", total=1.0)
        # Without a terminal a line for each quarter replaces the bar.
        quarters = iter((0.25, 0.5, 0.75, 1.0))
        due = next(quarters)

        def progress(share: float) -> None:
            nonlocal due
            bar.update(task, completed=share)
            while share >= due and not console.is_terminal:
                console.print(f"  moving: {due:.0%}")
                due = next(quarters, 2.0)

        def report(step: str) -> None:
            console.print(fold(f"- {step}"), soft_wrap=True, markup=False)

        result = run(report, progress, codec)
    _print_traffic(console, result.traffic)
    _print_checks(console, result)
    sys.exit(0 if result.passed else 1)


def _print_traffic(console: Console, traffic: Sequence[Traffic]) -> None:
    console.print("\nTraffic (seconds, direction, bytes, meaning):", style="bold")
    readings = _readings(traffic)
    hidden = 0
    for item, reading, shown in zip(traffic, readings, _worth_showing(readings)):
        if not shown:
            hidden += 1
            continue
        if hidden:
            console.print(f"          ... {hidden} more like these")
            hidden = 0
        message = reading.message if reading else None
        meaning = format_message(message) if message else "noise"
        time = item.time - traffic[0].time
        line = f"{time:7.3f} {ARROWS[item.direction]} {as_hex(item.data)}  {meaning}"
        console.print(fold(line), soft_wrap=True, markup=False)


def _readings(traffic: Sequence[Traffic]) -> list[Reading | None]:
    codec = codecs.load(TABLE)
    readers = {
        "sent": FrameReader(codec, DIRECTIONS[:1]),
        "received": FrameReader(codec, DIRECTIONS[1:]),
    }
    found = (readers[item.direction].read(item.data) for item in traffic)
    return [readings[0] if readings else None for readings in found]


def _worth_showing(readings: Sequence[Reading | None]) -> list[bool]:
    """Return which messages to show: of repeated queries only the first ones and the last one."""
    shown = [False] * len(readings)
    kinds: dict[object, list[int]] = {}
    for index, reading in enumerate(readings):
        command = reading.message.command if reading and reading.message else None
        if command is None or command.safety != "query":
            kinds.clear()
        kind = command, reading.direction if reading else None
        seen = kinds.setdefault(kind, [])
        seen.append(index)
        shown[index] = True
        if len(seen) > SHOWN_FIRST + 1:
            shown[seen[-2]] = False
    return shown


def _print_checks(console: Console, result: Result) -> None:
    console.print("\nReplies:", style="bold")
    for check in result.checks:
        style, verdict = ("green", "right") if check.passed else ("red", "WRONG")
        expected = "" if check.passed else f", expected {check.expected}"
        text = escape(f"{check.what}: {check.found}{expected}")
        console.print(f"  [{style}]{verdict}[/{style}]  {text}", soft_wrap=True)
    right = sum(check.passed for check in result.checks)
    console.print(f"{right} of {len(result.checks)} replies are right", style="bold")
