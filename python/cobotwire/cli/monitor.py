"""``cobotwire monitor``: where the arm is, as it moves, and how its line does."""

from __future__ import annotations

import json
import sys

import click
from rich.console import Console
from rich.live import Live
from rich.table import Table as Grid
from rich.text import Text

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.call import plain
from cobotwire.cli.link import link_options, linked
from cobotwire.cli.serving import say
from cobotwire.health import Monitor, Sample


@click.command()
@click.argument("port", metavar="URL")
@link_options
@click.option("--rate", type=float, default=5.0, show_default=True, help="Looks a second, at most.")
@click.option("--count", type=click.IntRange(1), help="So many looks [default: until Ctrl-C].")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a look.")
@click.pass_obj
def monitor(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    rate: float,
    count: int | None,
    as_json: bool,
) -> None:
    """Watch the arm at URL: its joints and coordinates, the rate reached, errors and noise.

    Only queries are sent. On a terminal it is a table; else, or with --json, a line a look. Ctrl-C
    ends it: the port is given back, and a recording is whole.
    """
    package = editions.load(edition)
    table = package.TABLE
    try:
        with linked(port, table, baudrate, record) as link:
            looking = Monitor(package.CLIENT(link), codecs.load(table), rate)
            if as_json or not sys.stdout.isatty():
                for sample in looking.samples(count):
                    say(_as_json(sample) if as_json else _line(sample))
                return
            with Live(console=Console(), auto_refresh=False) as live:
                for sample in looking.samples(count):
                    live.update(_grid(port, sample), refresh=True)
    except KeyboardInterrupt:
        # The usual end, and no failure; `with` has left everything in order.
        sys.exit(0)


def _as_json(sample: Sample) -> str:
    values = {name: plain(value) for name, value in sample.values.items()}
    return json.dumps({**sample._asdict(), "values": values})


def _numbers(value: object) -> str:
    if not isinstance(value, tuple):
        return "no answer"
    return " ".join(f"{part:8.2f}" for part in value)


def _line(sample: Sample) -> str:
    values = "  ".join(f"{name} {_numbers(value)}" for name, value in sample.values.items())
    return f"{sample.time:9.3f}  {values}  {_state(sample)}"


def _state(sample: Sample) -> str:
    words = [f"{sample.rate:.1f}/s", f"{sample.unanswered} unanswered", f"{sample.late} late"]
    words.append(f"{sample.noise} bytes of noise" + f": {sample.diagnosis}" * bool(sample.noise))
    return ", ".join(words)


def _grid(port: str, sample: Sample) -> Grid:
    grid = Grid(title=f"{port}   {sample.time:.1f} s", show_header=False)
    for name, value in sample.values.items():
        parts = value._asdict().items() if hasattr(value, "_asdict") else ()
        named = "  ".join(f"{part} {number:8.2f}" for part, number in parts)
        grid.add_row(name, named or "[red]no answer[/red]")
    grid.add_row("rate", f"{sample.rate:.1f} a second")
    grid.add_row("unanswered", f"{sample.unanswered}   (late {sample.late})")
    grid.add_row("noise", Text(f"{sample.noise} bytes   {sample.diagnosis}"))
    # Plain text: what came over the line may look like markup, and is none.
    grid.add_row("last error", Text(sample.error))
    return grid
