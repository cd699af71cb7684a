"""Options and functions that subcommands share: reading editions, and reporting problems."""

from __future__ import annotations

import json
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import click
from jinja2 import TemplateSyntaxError

from cobotwire_codegen.errors import Problem, SpecError, nearest
from cobotwire_codegen.render import template_names

DEFAULT_EDITION = "spec/editions/mycobot.yaml"
FORMATS = ("text", "json", "github")

root_option = click.option(
    "--root",
    type=click.Path(exists=True, file_okay=False),
    default=".",
    help="The folder that contains spec/; file names in messages are relative to it.",
)
format_option = click.option(
    "--format",
    type=click.Choice(FORMATS),
    default="text",
    show_default=True,
    help="How problems are printed.",
)


@contextmanager
def report_problems(format: str = "text") -> Iterator[None]:
    """Print a spec's problems and exit with code 2."""
    try:
        yield
    except SpecError as error:
        print_problems(error.problems, format)
        if format == "text":
            click.echo(f"{len(error.problems)} problem(s) in the spec", err=True)
        sys.exit(2)


@contextmanager
def report_template_errors(folder: Path | None) -> Iterator[None]:
    """Report a mistake in a user's template in one line and exit with code 2.

    Without a ``folder``, all templates are built in, and a mistake in them is a bug.
    """
    try:
        yield
    except TemplateSyntaxError as error:
        raise click.UsageError(f"{error.filename}:{error.lineno}: {error.message}") from error
    except Exception as error:  # a user's template can raise anything
        if folder is None:
            raise
        frames = [
            f for f in traceback.extract_tb(error.__traceback__) if f.filename.endswith(".j2")
        ]
        place = f"{frames[-1].filename}:{frames[-1].lineno}: " if frames else ""
        raise click.UsageError(f"{place}{type(error).__name__}: {error}") from error


def check_names(folder: Path | None) -> None:
    """Raise an error if a user's template has a name that no built-in template has."""
    if folder is None:
        return
    known = template_names()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = path.relative_to(folder).as_posix()
        if name not in known:
            raise click.UsageError(f"{path}: there is no template {name}{nearest(name, known)}")


@contextmanager
def report_write_errors() -> Iterator[None]:
    """Report a file that cannot be written in one line and exit with code 2."""
    try:
        yield
    except OSError as error:
        raise click.UsageError(f"cannot write {error.filename}: {error.strerror}") from error


def print_problems(problems: Sequence[Problem], format: str) -> None:
    """Print problems as lines, as JSON, or as GitHub annotations."""
    if format == "json":
        click.echo(json.dumps([_plain(problem) for problem in problems], indent=1))
        return
    for problem in problems:
        click.echo(_github(problem) if format == "github" else str(problem), err=format == "text")


def _plain(problem: Problem) -> dict[str, str | int]:
    place = problem.place
    return {
        "file": place.file,
        "line": place.line,
        "column": place.column,
        "code": problem.code,
        "message": problem.message,
    }


def _github(problem: Problem) -> str:
    place = problem.place
    # GitHub requires these escapes in an annotation.
    message = problem.message.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    where = f"file={place.file},line={place.line},col={place.column},title={problem.code}"
    return f"::error {where}::{message}"


def edition_path(file: str) -> Path:
    """Return the path of the edition file that the command line names."""
    path = Path(file)
    if not path.is_file():
        clone = "; only a clone of the project has this default: name your own file"
        hint = clone if file == DEFAULT_EDITION else ""
        raise click.UsageError(f"there is no file {file}{hint}")
    return path
