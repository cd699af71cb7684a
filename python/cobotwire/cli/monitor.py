"""``cobotwire monitor``: show where the arm is, and the state of its port."""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import click
from rich.console import Console
from rich.constrain import Constrain
from rich.live import Live
from rich.table import Table as Grid
from rich.text import Text

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.shared.arm_options import arm_options, open_arm
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.output import ECHO_COLUMNS, print_line
from cobotwire.inspect import Monitor, Observation
from cobotwire.inspect.following import SCHEME, FollowedRecording
from cobotwire.inspect.monitor import FollowingMonitor, monitored
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.json_values import as_json_value

# Widths in characters: of a number with its name and the space after it; of the borders, minus the
# space that the last number does not need.
NUMBER_COLUMNS, BORDER_COLUMNS = 13, 5


@click.command()
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@arm_options
@click.option(
    "--rate", type=float, default=5.0, show_default=True, help="Samples a second, at most."
)
@click.option("--count", type=click.IntRange(1), help="Number of samples [default: until Ctrl-C].")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per sample.")
@uses_edition
def monitor(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    rate: float,
    count: int | None,
    as_json: bool,
) -> None:
    """Show joints and coordinates of the arm at URL, the sample rate, errors and noise.

    With follow:FILE, nothing is sent. The values come from a recording that another program, such
    as cobotwire tap, is writing.

    Only queries are sent. A query without a reply in time is repeated, and each repeat counts as a
    request. The reply to an unanswered request may still come: then it is late. On a terminal the
    output is a live table. Elsewhere, or with --json, it is one line per sample. Ctrl-C closes the
    port and finishes the recording.
    """
    try:
        if port.startswith(SCHEME):
            if record is not None:
                message = "with follow:FILE there is nothing to record"
                raise UsageError("record", record, message=message)
            with FollowedRecording(port, edition) as followed:
                _print(port, FollowingMonitor(followed, rate).samples(count), as_json)
            return
        package = editions.load(edition)
        table = package.TABLE
        monitored(table)
        with (
            open_arm(port, table, baudrate, record) as transport,
            package.CLIENT(transport, on_error="leave") as arm,
        ):
            _print(port, Monitor(arm, codecs.load(table), rate).samples(count), as_json)
    except KeyboardInterrupt:
        # Ctrl-C is the usual way to end this subcommand, not a failure.
        sys.exit(0)


def _print(port: str, samples: Iterator[Observation], as_json: bool) -> None:
    if as_json or not sys.stdout.isatty():
        for sample in samples:
            print_line(_as_json(sample) if as_json else _line(sample))
        return
    with Live(console=Console(), auto_refresh=False) as live:
        width = live.console.width - ECHO_COLUMNS
        for sample in samples:
            shown = Constrain(_grid(port, sample, width), width)
            with _signals_wait():
                live.update(shown, refresh=True)


@contextmanager
def _signals_wait() -> Iterator[None]:
    """Delay Ctrl-C while the table is written; otherwise part of the table would appear twice."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _as_json(sample: Observation) -> str:
    values = {name: as_json_value(value) for name, value in sample.values.items()}
    return json.dumps({**sample._asdict(), "values": values})


def _numbers(value: object) -> str:
    if not isinstance(value, tuple):
        return "no reply"
    return " ".join(f"{part:8.2f}" for part in value)


def _line(sample: Observation) -> str:
    values = "  ".join(f"{name} {_numbers(value)}" for name, value in sample.values.items())
    state = [f"{sample.rate:.1f}/s", _counts(sample)]
    state.append(f"{sample.noise} bytes of noise" + f": {sample.diagnosis}" * bool(sample.noise))
    return f"{sample.time:9.3f}  {values}  {', '.join(state)}"


def _counts(sample: Observation) -> str:
    return f"{sample.sent} sent, {sample.unanswered} unanswered, {sample.late} late"


def _grid(port: str, sample: Observation, width: int) -> Grid:
    grid = Grid(title=f"{port}   {sample.time:.1f} s", show_header=False)
    # A row is broken between two numbers, not between the name of a number and its value.
    labels = max(map(len, (*sample.values, "last error")))
    most = max(1, (width - labels - BORDER_COLUMNS) // NUMBER_COLUMNS)
    for name, value in sample.values.items():
        parts = value._asdict().items() if hasattr(value, "_asdict") else ()
        named = [f"{part:<2} {number:8.2f}" for part, number in parts]
        rows = ["  ".join(named[at : at + most]) for at in range(0, len(named), most)]
        grid.add_row(name, "\n".join(rows) or "[red]no reply[/red]")
    grid.add_row("rate", f"{sample.rate:.1f} a second")
    grid.add_row("requests", _counts(sample))
    # As plain text, because received bytes may look like markup.
    grid.add_row("noise", Text(f"{sample.noise} bytes   {sample.diagnosis}"))
    grid.add_row("last error", Text(sample.error))
    return grid
