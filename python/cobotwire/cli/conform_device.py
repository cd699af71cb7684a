"""``cobotwire conform device``: test an arm and its firmware against an edition."""

from __future__ import annotations

from dataclasses import replace

import click

from cobotwire import editions
from cobotwire.cli.shared.arm_options import address_option, baudrate_option
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.conform_report import (
    ReportOptions,
    conclude,
    exit_if_not_testable,
    report_options,
)
from cobotwire.cli.shared.earlier_reports import earlier_report
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.progress_bar import step_progress
from cobotwire.cli.shared.subject_connection import STARTING, Lacking, Subject, connected
from cobotwire.conformance.device import (
    ATTACH,
    PERMISSIONS,
    Plan,
    RunOptions,
    Tester,
)
from cobotwire.conformance.provenance import identify
from cobotwire.conformance.sources import spec_lines
from cobotwire.conformance.statement import (
    Statement,
    load_statement,
    read_statement,
    with_deadlines,
)
from cobotwire.protocol.errors import LinkError


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
@click.option("--command", metavar="COMMAND", help="Start this program, test it, and stop it.")
@click.option(
    "--attach",
    type=click.Choice(ATTACH),
    help="With --command: how to connect [default: pty if COMMAND has {port}, else stdio].",
)
@click.option(
    "--statement",
    type=click.Path(),
    metavar="FILE",
    help="What the arm has and lacks (YAML); `conform statement` prints a template.",
)
@click.option(
    "--resume",
    type=click.Path(),
    metavar="REPORT",
    help="Continue the run of a JSON report, with its options: run the rest of the test cases.",
)
@click.option(
    "--again",
    type=click.Path(),
    metavar="REPORT",
    help="Repeat the run of a JSON report, with its options and in its order.",
)
@report_options
@uses_edition
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
    command: str | None,
    attach: str | None,
    statement: str | None,
    resume: str | None,
    again: str | None,
    wanted: ReportOptions,
) -> None:
    """Test the arm at URL against an edition.

    By default only queries are sent; --allow permits more. Motion also needs --max-speed and
    --workspace. Settings are restored at the end; Ctrl-C stops the arm and restores them too.

    --command tests a program. It is connected by its standard input and output, by a
    pseudo-terminal (the word {port} in COMMAND becomes its path), or by the port that it prints
    (--attach port).

    Exit codes: 0 the arm conforms; 1 it does not; 2 it could not be tested.
    """
    with exit_if_not_testable():
        table = editions.load(edition).TABLE
        options = RunOptions(
            allow,
            max_speed,
            workspace,
            repeat,
            retries,
            optional,
            address,
            linger,
            baudrate,
            expected=wanted.expected,
            expected_name=wanted.expected_name,
        )
        subject = Subject(port, command, attach, simulated, baudrate)
        given = options.for_report() | ({"statement": statement} if statement else {})
        earlier = earlier_report(resume, again, given, edition, "device")
        if earlier is None:
            plan = Plan()
            declared = load_statement(statement, table) if statement else Statement()
        else:
            options = RunOptions.of_report(earlier.options)
            plan = Plan(earlier, resume=resume is not None)
            text = earlier.statement
            declared = read_statement(text, table, "the report") if text else Statement()
        options = options.completed(declared.ixit)
        table = with_deadlines(table, declared.deadlines)
        options.validate(table)
        known = options.known_failures()
        lacking = Lacking(table)
        subject = replace(subject, baudrate=options.baudrate)
        with connected(table, subject, lacking) as connection:
            tester = options.tester(
                connection, table, spec_lines(edition), declared, lacking.reasons
            )
            identify(tester.report, edition, port=connection.name)
            if subject.command is not None:
                tester.device.await_start(STARTING)
            _run(tester, plan)
    conclude(tester.report, wanted, known)


def _run(tester: Tester, plan: Plan) -> None:
    """Run with a progress bar; if the run is interrupted, the report holds what was tested."""
    try:
        with step_progress() as show:
            tester.run(lambda step, done, count: show(step.name, done, count), plan)
    except KeyboardInterrupt:
        click.echo("interrupted: the arm was stopped, and its settings were restored", err=True)
    except LinkError as error:
        click.echo(f"cobotwire: {error}", err=True)
