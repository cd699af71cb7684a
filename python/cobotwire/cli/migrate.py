"""``cobotwire migrate``: rewrite programs that were written for the maker's library."""

from __future__ import annotations

import difflib
import json
import sys
from pathlib import Path

import click

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable

_COLOURS = {"+": "green", "-": "red", "@": "cyan"}


@click.command()
@click.argument("scripts", nargs=-1, required=True, type=click.Path(), metavar="SCRIPT...")
@click.option("--write", is_flag=True, help="Change the files; without it, show what would change.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per file.")
def migrate(scripts: tuple[str, ...], write: bool, as_json: bool) -> None:
    """Rewrite programs that were written for pymycobot, to use our clients.

    Prints what changes as a diff. A call is rewritten if the new one sends the same bytes, and its
    result can be used in the same way. Each place where that is not certain is listed on standard
    error with its line, the reason, and what to do. Do that before you run the program.

    Exit codes: 0 nothing is left to decide; 1 a place is listed; 2 wrong usage, or LibCST is not
    installed.
    """
    try:
        from cobotwire.pymycobot.migrate import migrate as rewrite
    except ImportError:
        click.echo("cobotwire: migrate needs LibCST: pip install 'cobotwire[migrate]'", err=True)
        sys.exit(2)
    texts = [(script, _read(script)) for script in scripts]
    made = [(script, text, rewrite(text, script)) for script, text in texts]
    for script, text, migrated in made:
        if as_json:
            decisions = [decision._asdict() for decision in migrated.decisions]
            changed = migrated.text != text
            shown = {"file": script, "changed": changed, "text": migrated.text}
            click.echo(json.dumps({**shown, "decisions": decisions}))
        elif not write:
            _show_diff(script, text, migrated.text)
        for decision in () if as_json else migrated.decisions:
            click.echo(f"{printable(script)}:{decision}", err=True)
        if write and migrated.text != text:
            Path(script).write_text(migrated.text, encoding="utf-8", newline="")
            click.echo(f"wrote {printable(script)}", err=as_json)
    left = sum(len(migrated.decisions) for _, _, migrated in made)
    if left and not as_json:
        places = "1 place" if left == 1 else f"{left} places"
        click.echo(f"{places} to decide before you run what was rewritten", err=True)
    sys.exit(1 if left else 0)


def _read(script: str) -> str:
    try:
        with open(script, encoding="utf-8", newline="") as file:
            return file.read()
    except IsADirectoryError:
        message = f"{script} is a folder; name the programs in it"
        raise UsageError("script", script, message=message) from None
    except OSError as error:
        raise UsageError("script", script, message=f"{script}: {error.strerror}") from None
    except UnicodeDecodeError as error:
        message = f"{script} is not a program in UTF-8: {error}"
        raise UsageError("script", script, message=message) from None


def _show_diff(script: str, before: str, after: str) -> None:
    lines = difflib.unified_diff(
        before.splitlines(), after.splitlines(), script, f"{script} (rewritten)", lineterm=""
    )
    for line in lines:
        click.secho(printable(line), fg=_COLOURS.get(line[:1]))
