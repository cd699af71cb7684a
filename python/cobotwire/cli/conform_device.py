"""``cobotwire conform device``: test an arm and its firmware against an edition."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from cobotwire import editions
from cobotwire.capture.file_errors import unusable_file
from cobotwire.cli.shared.arm_options import address_option, baudrate_option
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.conform_report import (
    ReportFiles,
    conclude,
    exit_if_not_testable,
    report_options,
)
from cobotwire.conformance import Report
from cobotwire.conformance.device import (
    PERMISSIONS,
    DeviceConnection,
    Plan,
    RunOptions,
    Step,
    Tester,
)
from cobotwire.conformance.reports import from_json
from cobotwire.conformance.sources import spec_lines
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.arm import Note
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.transport import open_transport

IN_MEMORY = "simulated arm in memory"


@click.command()
@click.argument("port", metavar="URL", required=False, shell_complete=complete_ports)
@click.option(
    "--allow",
    default="",
    metavar="PERMISSIONS",
    help=f"What may be sent besides queries, any of {','.join(PERMISSIONS)}.",
)
@click.option("--max-speed", type=int, help="The highest speed to move at, in percent.")
@click.option(
    "--workspace",
    metavar="RANGES",
    help="Allowed degrees for all joints, -30:30, or for each: 1=-90:90,2=-30:30,...",
)
@click.option(
    "--repeat", type=int, default=1, show_default=True, help="How often to run each test case."
)
@click.option(
    "--retries",
    type=int,
    default=0,
    show_default=True,
    help="How often to repeat a query that gets no reply.",
)
@click.option(
    "--optional",
    default="",
    metavar="COMMANDS",
    help="Commands that the arm need not support, separated by commas.",
)
@baudrate_option
@address_option
@click.option("--linger", type=float, help="Milliseconds to listen after a reply [default: 4].")
@click.option("--simulated", is_flag=True, help="Test a simulated arm instead of URL.")
@click.option(
    "--resume",
    type=click.Path(),
    metavar="REPORT",
    help="Continue the run of a JSON report: run what it did not run, with its options.",
)
@click.option(
    "--again",
    type=click.Path(),
    metavar="REPORT",
    help="Repeat the run of a JSON report, with its options and in its order.",
)
@report_options
@click.pass_obj
def device(
    edition: str,
    port: str | None,
    allow: str,
    max_speed: int | None,
    workspace: str | None,
    repeat: int,
    retries: int,
    optional: str,
    baudrate: int | None,
    address: str | None,
    linger: float | None,
    simulated: bool,
    resume: str | None,
    again: str | None,
    files: ReportFiles,
) -> None:
    """Test the arm at URL against an edition.

    By default only queries are sent; --allow permits more. Motion also needs --max-speed and
    --workspace. Settings are restored at the end; Ctrl-C stops the arm and restores them too.

    Exit codes: 0 the arm conforms; 1 it does not; 2 it could not be tested.
    """
    with exit_if_not_testable():
        table = editions.load(edition).TABLE
        options = RunOptions(
            allow, max_speed, workspace, repeat, retries, optional, address, linger, baudrate
        )
        plan = Plan()
        if resume is not None or again is not None:
            earlier = _earlier(resume, again, options, edition)
            options = RunOptions.of_report(earlier.options)
            plan = Plan(earlier, resume=resume is not None)
        options.validate(table)
        statement = _Statement(table)
        with _connection(table, port, simulated, options.baudrate, statement) as connection:
            tester = options.tester(connection, table, spec_lines(edition), statement.reasons)
            _run(tester, plan)
    conclude(tester.report, files)


def _earlier(resume: str | None, again: str | None, given: RunOptions, edition: str) -> Report:
    """Return the report to continue or to repeat.

    Raises:
        UsageError: its file is no report of the edition, or options are given in addition.
    """
    name = "--again" if resume is None else "--resume"
    path = again if resume is None else resume
    if path is None or (resume is not None and again is not None):
        raise UsageError("again", again, message="give either --resume or --again, not both")
    if given != RunOptions():
        names = ", ".join(f"--{each.replace('_', '-')}" for each in given.for_report())
        raise UsageError("options", message=f"{name} uses the options of the report: omit {names}")
    try:
        report = from_json(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeError) as error:
        raise unusable_file(name.removeprefix("--"), path, error) from error
    if report.edition != edition:
        message = f"{path} is about the edition {report.edition}; add --edition {report.edition}"
        raise UsageError("edition", edition, message=message)
    return report


def _run(tester: Tester, plan: Plan) -> None:
    """Run with a progress bar; if the run is interrupted, the report holds what was tested."""
    try:
        with _progress() as show_step:
            tester.run(show_step, plan)
    except KeyboardInterrupt:
        click.echo("interrupted: the arm was stopped, and its settings were restored", err=True)
    except LinkError as error:
        click.echo(f"cobotwire: {error}", err=True)


@contextmanager
def _progress() -> Iterator[Callable[[Step, int, int], None]]:
    """Yield a function that shows the current step on standard error, if that is a terminal."""
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("")

        def show_step(step: Step, index: int, count: int) -> None:
            bar.update(task, description=step.name, completed=index, total=count)

        yield show_step


class _Statement:
    """What a simulated arm states that it does not support: coordinates of an unknown geometry."""

    def __init__(self, table: Table) -> None:
        self.reasons: dict[str, str] = {}
        self._table = table
        self._why = table.robot.why_no_geometry

    def note(self, note: Note) -> None:
        """Keep a note of the arm if it says so."""
        if note.text.endswith(self._why):
            id = self._table.command(note.command).id
            same = [command.name for command in self._table.commands if command.id == id]
            self.reasons |= dict.fromkeys(same, self._why)


@contextmanager
def _connection(
    table: Table, port: str | None, simulated: bool, baudrate: int | None, statement: _Statement
) -> Iterator[DeviceConnection]:
    if simulated == (port is not None):
        raise UsageError("URL", port, message="give either the URL of an arm or --simulated")
    if port is None:
        clock = SteppedClock()
        arm = SimulatedArm(table, clock=clock, on_note=statement.note)
        yield DeviceConnection(MemoryTransport(arm, clock), clock, IN_MEMORY)
        return
    opened = open_transport(port, table.baudrate if baudrate is None else baudrate)
    try:
        yield DeviceConnection(opened)
    finally:
        opened.close()
