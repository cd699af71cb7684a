"""``cobotwire conform device``: test an arm and its firmware against an edition."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click
from rich.console import Console
from rich.progress import Progress

from cobotwire import editions
from cobotwire.cli.shared.arm_options import address_option, baudrate_option, parse_address
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.conform_report import (
    ReportFiles,
    conclude,
    exit_if_not_testable,
    report_options,
)
from cobotwire.conformance.device import (
    PERMISSIONS,
    DeviceConnection,
    Permissions,
    Step,
    Tester,
    Timing,
    parse_workspace,
    words,
)
from cobotwire.conformance.sources import spec_lines
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm
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
    files: ReportFiles,
) -> None:
    """Test the arm at URL against an edition.

    By default only queries are sent; --allow permits more. Motion also needs --max-speed and
    --workspace. Settings are restored at the end; Ctrl-C stops the arm and restores them too.

    Exit codes: 0 the arm conforms; 1 it does not; 2 it could not be tested.
    """
    with exit_if_not_testable():
        table = editions.load(edition).TABLE
        for name, value, least in (("repeat", repeat, 1), ("retries", retries, 0)):
            if value < least:
                raise UsageError(name, value, f"a whole number from {least}")
        permissions = Permissions.of(
            words(allow),
            joints=table.joints,
            max_speed=max_speed,
            workspace=None if workspace is None else parse_workspace(workspace, table.joints),
        )
        names = frozenset(table.command(name).name for name in words(optional))
        timing = Timing() if linger is None else Timing(linger=linger / 1000)
        with _connection(table, port, simulated, baudrate) as connection:
            tester = Tester(
                connection,
                table,
                permissions=permissions,
                sources=spec_lines(edition),
                timing=timing,
                repeat=repeat,
                retries=retries,
                optional=names,
                address=None if address is None else parse_address(address),
            )
            _run(tester)
    conclude(tester.report, files)


def _run(tester: Tester) -> None:
    """Run with a progress bar; if the run is interrupted, the report holds what was tested."""
    try:
        with _progress() as show_step:
            tester.run(show_step)
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


@contextmanager
def _connection(
    table: Table, port: str | None, simulated: bool, baudrate: int | None
) -> Iterator[DeviceConnection]:
    if simulated == (port is not None):
        raise UsageError("URL", port, message="give either the URL of an arm or --simulated")
    if port is None:
        clock = SteppedClock()
        yield DeviceConnection(
            MemoryTransport(SimulatedArm(table, clock=clock), clock), clock, IN_MEMORY
        )
        return
    opened = open_transport(port, table.baudrate if baudrate is None else baudrate)
    try:
        yield DeviceConnection(opened)
    finally:
        opened.close()
