"""``cobotwire conform device``: does this arm, this firmware, keep to an edition?"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import click

from cobotwire import editions
from cobotwire.cli.conforming import ReportFiles, conclude, could_not_run, report_options
from cobotwire.cli.progress import Shown
from cobotwire.conformance.device import CLASSES, Leave, Line, Tester, Waits, words, workspace_of
from cobotwire.conformance.places import places_of
from cobotwire.errors import LinkError, UsageError
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.memory import MemoryLink
from cobotwire.table import Table
from cobotwire.transport import open_link

IN_MEMORY = "simulated arm in memory"


@click.command()
@click.argument("port", metavar="URL", required=False)
@click.option(
    "--allow", default="", metavar="CLASSES", help=f"What may be sent: {','.join(CLASSES)}."
)
@click.option("--max-speed", type=int, help="Percent of the fastest that motion may take.")
@click.option(
    "--workspace",
    metavar="RANGES",
    help="Degrees of every joint, -30:30, or of each: 1=-90:90,2=-30:30,...",
)
@click.option("--repeat", type=int, default=1, show_default=True, help="Run each trial so often.")
@click.option("--retries", type=int, default=0, show_default=True, help="Ask again so often.")
@click.option("--optional", default="", metavar="COMMANDS", help="What the arm may lack.")
@click.option("--baudrate", type=int, help="Bits a second [default: the edition's].")
@click.option("--linger", type=float, help="Milliseconds to listen behind a reply [4].")
@click.option("--simulated", is_flag=True, help="Test a simulated arm in memory; no URL then.")
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
    linger: float | None,
    simulated: bool,
    files: ReportFiles,
) -> None:
    """Test the arm at URL against an edition.

    Without --allow only queries are sent. Motion needs --max-speed and --workspace too. What is set
    is set back; Ctrl-C stops the arm and sets back. Exit codes: 0 the arm conforms; 1 it does not;
    2 it could not be tested.
    """
    with could_not_run():
        table = editions.load(edition).TABLE
        if repeat < 1 or retries < 0:
            raise UsageError("repeat, retries", (repeat, retries), "repeat from 1, retries from 0")
        leave = Leave.of(
            words(allow),
            joints=table.joints,
            max_speed=max_speed,
            workspace=None if workspace is None else workspace_of(workspace, table.joints),
        )
        names = frozenset(table.command(name).name for name in words(optional))
        waits = Waits() if linger is None else Waits(linger=linger / 1000)
        with _line(table, port, simulated, baudrate) as line:
            tester = Tester(
                line,
                table,
                leave=leave,
                places=places_of(edition),
                waits=waits,
                repeat=repeat,
                retries=retries,
                optional=names,
            )
            _run(tester)
    conclude(tester.report, files)


def _run(tester: Tester) -> None:
    """Run, and show how far it is; an end before the end leaves the report as it is."""
    try:
        with Shown() as shown:
            tester.run(shown.step)
    except KeyboardInterrupt:
        click.echo("interrupted: the arm was stopped, and set back", err=True)
    except LinkError as error:
        click.echo(f"cobotwire: {error}", err=True)


@contextmanager
def _line(table: Table, port: str | None, simulated: bool, baudrate: int | None) -> Iterator[Line]:
    if simulated == (port is not None):
        raise UsageError("URL", port, "a port or URL; or --simulated in its place")
    if port is None:
        clock = SteppedClock()
        yield Line(MemoryLink(SimulatedArm(table, clock=clock), clock), clock, IN_MEMORY)
        return
    link = open_link(port, table.baudrate if baudrate is None else baudrate)
    try:
        yield Line(link)
    finally:
        link.close()
