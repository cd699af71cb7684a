"""What the verbs share: the root, reading editions, and telling problems."""

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

FORMATS = ("text", "json", "github")

root_option = click.option(
    "--root",
    type=click.Path(exists=True, file_okay=False),
    default=".",
    help="The folder that file names in messages are relative to, and that holds spec/.",
)
format_option = click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    default="text",
    show_default=True,
    help="How problems are told.",
)


@contextmanager
def problems_told(form: str = "text") -> Iterator[None]:
    """Turn a spec's problems into lines and exit code 2."""
    try:
        yield
    except SpecError as error:
        tell(error.problems, form)
        if form == "text":
            click.echo(f"{len(error.problems)} problem(s) in the spec", err=True)
        sys.exit(2)


@contextmanager
def template_errors_told(folder: Path | None) -> Iterator[None]:
    """Turn a mistake in somebody's own template into one line and exit code 2.

    Without a ``folder`` all templates are ours, and a mistake in them is a fault of this program.
    """
    try:
        yield
    except TemplateSyntaxError as error:
        raise click.UsageError(f"{error.filename}:{error.lineno}: {error.message}") from error
    except Exception as error:  # whatever a template of somebody's own can do
        if folder is None:
            raise
        frames = [
            f for f in traceback.extract_tb(error.__traceback__) if f.filename.endswith(".j2")
        ]
        place = f"{frames[-1].filename}:{frames[-1].lineno}: " if frames else ""
        raise click.UsageError(f"{place}{type(error).__name__}: {error}") from error


def check_names(folder: Path | None) -> None:
    """A template takes the place of one of ours: a name that none of ours has is a mistake."""
    if folder is None:
        return
    known = template_names()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = path.relative_to(folder).as_posix()
        if name not in known:
            raise click.UsageError(f"{path}: there is no template {name}{nearest(name, known)}")


@contextmanager
def unwritable_told() -> Iterator[None]:
    """Turn a file that cannot be written into one line and exit code 2."""
    try:
        yield
    except OSError as error:
        raise click.UsageError(f"cannot write {error.filename}: {error.strerror}") from error


def tell(problems: Sequence[Problem], form: str) -> None:
    """Print problems: as lines for people, as JSON, or as GitHub's annotations."""
    if form == "json":
        click.echo(json.dumps([_plain(problem) for problem in problems], indent=1))
        return
    for problem in problems:
        click.echo(_github(problem) if form == "github" else str(problem), err=form == "text")


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
    # What GitHub asks for in the properties and the message of an annotation.
    message = problem.message.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    where = f"file={place.file},line={place.line},col={place.column},title={problem.code}"
    return f"::error {where}::{message}"


def edition_path(file: str) -> Path:
    """The edition file that a person named."""
    path = Path(file)
    if not path.is_file():
        raise click.UsageError(f"there is no file {file}")
    return path
