"""``cobotwire conform codec``: test a codec, in any language, against an edition."""

from __future__ import annotations

import shlex
from dataclasses import replace

import click

from cobotwire import editions
from cobotwire.cli.shared.conform_report import (
    ReportOptions,
    conclude,
    exit_if_not_testable,
    report_options,
)
from cobotwire.cli.shared.earlier_reports import earlier_report
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.conformance.codec import CodecOptions, Program, Run
from cobotwire.conformance.provenance import identify
from cobotwire.conformance.sources import spec_lines
from cobotwire.protocol.errors import UsageError


# Our options come before COMMAND; everything after it belongs to COMMAND.
@click.command(context_settings={"allow_interspersed_args": False})
@click.argument("command", nargs=-1)
@click.option("--only", metavar="PATTERN", help="Send only questions with a matching name.")
@click.option(
    "--timeout", type=float, default=10.0, show_default=True, help="Seconds to wait for an answer."
)
@click.option(
    "--repeat", type=int, default=1, show_default=True, help="How often to send each question."
)
@click.option(
    "--again",
    type=click.Path(),
    metavar="REPORT",
    help="Repeat the run of a JSON report, with its command and options.",
)
@report_options
@uses_edition
def codec(
    edition: str,
    command: tuple[str, ...],
    only: str | None,
    timeout: float,
    repeat: int,
    again: str | None,
    wanted: ReportOptions,
) -> None:
    """Test the codec that COMMAND runs against an edition.

    COMMAND reads questions on standard input and writes answers on standard output, as
    docs/codec-protocol.md describes:

    \b
      cobotwire conform codec -- python -m cobotwire.conformance.codec.adapter native
      cobotwire --edition mycobot280 conform codec -- ./my-codec --stdio
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with exit_if_not_testable():
        words = shlex.join(command)
        known_text, name = wanted.expected, wanted.expected_name
        options = CodecOptions(
            words, only or "", timeout, repeat, expected=known_text, expected_name=name
        )
        given = options.for_report()
        # With --again a new command is allowed: the earlier one may not run in this folder.
        given.pop("command", None)
        earlier = earlier_report(None, again, given, edition, "codec")
        if earlier is not None:
            options = CodecOptions.of_report(earlier.options)
            options = replace(options, command=words or options.command)
        if not options.command:
            raise UsageError("COMMAND", message="name the command that runs the codec, after --")
        if options.repeat < 1:
            raise UsageError("repeat", options.repeat, "a whole number from 1")
        known = options.known_failures()
        table = editions.load(edition).TABLE
        with Program(options.words, timeout=options.timeout) as program:
            lines = spec_lines(edition)
            run = Run(table, program, expected=known, repeat=options.repeat, sources=lines)
            run.report.options = options.for_report()
            identify(run.report, edition, port=options.command)
            try:
                run.ask_all(options.questions(table))
            except KeyboardInterrupt:
                click.echo("interrupted", err=True)
    conclude(run.report, wanted)
