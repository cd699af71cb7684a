"""``cobotwire-gen watch``: generate and check again whenever the spec changes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import click

from cobotwire_codegen.author.append import files_of
from cobotwire_codegen.cli.build import build
from cobotwire_codegen.cli.generate import generate
from cobotwire_codegen.cli.shared import edition_path, root_option
from cobotwire_codegen.errors import SpecError


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("words", nargs=-1, type=click.UNPROCESSED, metavar="[FILE --out FOLDER ...]")
@root_option
def watch(words: tuple[str, ...], root: str) -> None:
    """Generate again, and report problems, whenever a file of the spec changes. Ctrl-C ends it.

    Without FILE, this project's own files are generated; with FILE, the arguments are those of
    `cobotwire-gen build`. A problem in the spec does not end the watch, and changes no file.

    It needs watchfiles: pip install 'cobotwire-codegen[watch]'.
    """
    try:
        import watchfiles
    except ModuleNotFoundError:
        message = "watching needs watchfiles: pip install 'cobotwire-codegen[watch]'"
        raise click.ClickException(message) from None
    if words:
        edition_path(words[0])
    _generate(words, root)
    folders = sorted(_folders(words, root))
    click.echo(f"watching {', '.join(map(str, folders))}; Ctrl-C ends")
    # While it generates, click turns Ctrl-C into Abort.
    with suppress(KeyboardInterrupt, click.Abort):
        for changes in watchfiles.watch(*folders):
            names = sorted({Path(path).name for _, path in changes if path.endswith(".yaml")})
            if names:
                click.secho(f"changed: {', '.join(names)}", bold=True)
                _generate(words, root)


def _generate(words: tuple[str, ...], root: str) -> None:
    """Generate once; problems are printed."""
    command = build if words else generate
    arguments = list(words) if words else ["--root", root]
    try:
        command.main(arguments, prog_name="cobotwire-gen", standalone_mode=False)
    except click.ClickException as error:
        error.show()
    except SystemExit:
        pass  # the problems were printed


def _folders(words: tuple[str, ...], root: str) -> Iterator[Path]:
    """Return the folders with files of the spec."""
    if not words:
        return iter([Path(root) / "spec"])
    try:
        return iter({file.parent for file in files_of(Path(words[0]))})
    except SpecError:
        return iter([Path(words[0]).parent])
