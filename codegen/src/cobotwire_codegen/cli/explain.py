"""``cobotwire-gen explain``: explain a problem code, a key of the language, or a command."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire_codegen.author.codes import CODES
from cobotwire_codegen.author.describe import describe_code, describe_command, describe_keys
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.cli.shared import DEFAULT_EDITION, edition_path, report_problems
from cobotwire_codegen.errors import nearest


@click.command()
@click.argument("word", required=False)
@click.option(
    "--edition",
    "file",
    default=DEFAULT_EDITION,
    show_default=True,
    help="The edition of the commands that can be explained.",
)
def explain(word: str | None, file: str) -> None:
    """Explain WORD: a problem code, a key of the spec's language, or a command of the edition.

    Without WORD, list the codes.
    """
    if word is None:
        for code, explanation in sorted(CODES.items()):
            click.echo(f"{code:<20} {explanation.means}")
        return
    keys = describe_keys()
    if word in CODES or word in keys:
        click.echo(describe_code(CODES[word]) if word in CODES else keys[word])
        return
    if file == DEFAULT_EDITION and not Path(file).is_file():
        hint = f"{_hint(word, [*CODES, *keys])}; for a command, name its file: --edition FILE"
        raise click.UsageError(f"{word} is neither a problem code nor a key{hint}")
    with report_problems():
        # The edition is not checked, so that a command can be explained while it is being changed.
        edition = build_edition(edition_path(file), Path.cwd())
    commands = {command.name: command for command in edition.commands}
    if word not in commands:
        hint = _hint(word, [*CODES, *keys, *commands])
        raise click.UsageError(
            f"{word} is not a problem code, key or command of {edition.name}{hint}"
        )
    click.echo(describe_command(edition, commands[word]))


def _hint(word: str, known: list[str]) -> str:
    hint = nearest(word, known)
    # A list of two hundred words would not help.
    return hint if "did you mean" in hint else "; `cobotwire-gen explain` lists the codes"
