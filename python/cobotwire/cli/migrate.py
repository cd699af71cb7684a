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


@click.command(short_help="Rewrite a program for our clients.")
@click.argument("scripts", nargs=-1, required=True, type=click.Path(), metavar="SCRIPT...")
@click.option("--write", is_flag=True, help="Change the files; without it, show what would change.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per file.")
def migrate(scripts: tuple[str, ...], write: bool, as_json: bool) -> None:
    """Rewrite programs that were written for pymycobot, to use our clients.

    Prints what changes as a diff. What cannot be rewritten stays as it is; each such place is
    listed on standard error with its line, and what a person must decide there.

    Exit codes: 0 the programs are whole; 1 there is something to decide.
    """
    try:
        from cobotwire.pymycobot.migrate import migrate as rewrite
    except ImportError:
        sys.exit("cobotwire: migrate needs LibCST: pip install 'cobotwire[migrate]'")
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
    sys.exit(1 if any(migrated.decisions for _, _, migrated in made) else 0)


def _read(script: str) -> str:
    try:
        with open(script, encoding="utf-8", newline="") as file:
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError("script", script, f"a readable program in UTF-8 ({error})") from None


def _show_diff(script: str, before: str, after: str) -> None:
    lines = difflib.unified_diff(
        before.splitlines(), after.splitlines(), script, f"{script} (rewritten)", lineterm=""
    )
    for line in lines:
        click.secho(printable(line), fg=_COLOURS.get(line[:1]))
