"""``cobotwire conform codec``: does a codec, in whatever language, keep to an edition?"""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire import editions
from cobotwire.cli.conforming import ReportFiles, conclude, could_not_run, report_options
from cobotwire.conformance.codec import Program, Run, derive, read_expectations
from cobotwire.conformance.codec.expected import Expectation
from cobotwire.conformance.places import places_of
from cobotwire.errors import UsageError


# Options stand in front of the command; all behind it is the command's.
@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.argument("command", nargs=-1, required=True)
@click.option(
    "--expected", metavar="FILE", help="Failures that are known: a name and a reason a line."
)
@click.option("--only", metavar="PATTERN", help="Ask only trials with such a name.")
@click.option("--timeout", type=float, default=10.0, help="Seconds for each answer [10].")
@click.option("--repeat", type=int, default=1, help="Ask each trial so often [1].")
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
    """Ask COMMAND, over its standard input and output, what its codec makes of an edition.

    It speaks the line protocol of docs/codec-protocol.md:

    \b
      cobotwire conform codec -- python -m cobotwire.conformance.codec.adapter native
      cobotwire --edition mycobot280 conform codec -- ./my-codec --stdio
    """  # noqa: D301  (\b is the control character by which click keeps the lines)
    with could_not_run():
        if repeat < 1:
            raise UsageError("repeat", repeat, "a whole number from 1")
        known = _expectations(expected)
        table = editions.load(edition).TABLE
        trials = [trial for trial in derive(table) if only is None or _fits(trial.name, only)]
        with Program(command, timeout=timeout) as program:
            run = Run(table, program, expected=known, repeat=repeat, places=places_of(edition))
            try:
                run.ask_all(trials)
            except KeyboardInterrupt:
                click.echo("interrupted", err=True)
    conclude(run.report, files)


def _fits(name: str, pattern: str) -> bool:
    from fnmatch import fnmatchcase

    return fnmatchcase(name, pattern)


def _expectations(path: str | None) -> list[Expectation]:
    if path is None:
        return []
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeError) as error:
        raise UsageError("expected", path, f"a text file ({error})") from error
    return read_expectations(text, path)
