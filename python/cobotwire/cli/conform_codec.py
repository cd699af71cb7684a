"""``cobotwire conform codec``: test a codec, in any language, against an edition."""

from __future__ import annotations

from fnmatch import fnmatchcase
from pathlib import Path

import click

from cobotwire import editions
from cobotwire.capture.file_errors import unusable_file
from cobotwire.cli.shared.conform_report import (
    ReportFiles,
    conclude,
    exit_if_not_testable,
    report_options,
)
from cobotwire.conformance.codec import Program, Run, derive_questions, read_expectations
from cobotwire.conformance.codec.expected import Expectation
from cobotwire.conformance.sources import spec_lines
from cobotwire.protocol.errors import UsageError


# Our options come before COMMAND; everything after it belongs to COMMAND.
@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.argument("command", nargs=-1, required=True)
@click.option(
    "--expected",
    type=click.Path(),
    metavar="FILE",
    help="Known failures: a name and a reason per line.",
)
@click.option("--only", metavar="PATTERN", help="Send only questions with a matching name.")
@click.option(
    "--timeout", type=float, default=10.0, show_default=True, help="Seconds to wait for an answer."
)
@click.option(
    "--repeat", type=int, default=1, show_default=True, help="How often to send each question."
)
@report_options
@click.pass_obj
def codec(
    edition: str,
    command: tuple[str, ...],
    expected: str | None,
    only: str | None,
    timeout: float,
    repeat: int,
    files: ReportFiles,
) -> None:
    """Test a codec, which COMMAND runs, against an edition.

    COMMAND reads questions on standard input and writes answers on standard output, as
    docs/codec-protocol.md describes:

    \b
      cobotwire conform codec -- python -m cobotwire.conformance.codec.adapter native
      cobotwire --edition mycobot280 conform codec -- ./my-codec --stdio
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with exit_if_not_testable():
        if repeat < 1:
            raise UsageError("repeat", repeat, "a whole number from 1")
        known = _expectations(expected)
        table = editions.load(edition).TABLE
        every = derive_questions(table)
        questions = [each for each in every if only is None or fnmatchcase(each.name, only)]
        with Program(command, timeout=timeout) as program:
            run = Run(table, program, expected=known, repeat=repeat, sources=spec_lines(edition))
            try:
                run.ask_all(questions)
            except KeyboardInterrupt:
                click.echo("interrupted", err=True)
    conclude(run.report, files)


def _expectations(path: str | None) -> list[Expectation]:
    if path is None:
        return []
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeError) as error:
        raise unusable_file("expected", path, error) from error
    return read_expectations(text, path)
