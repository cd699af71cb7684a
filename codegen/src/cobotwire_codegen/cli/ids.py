"""``cobotwire-gen ids``: list the command ids of an edition, used and free."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from textwrap import fill

import click

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.cli.shared import DEFAULT_EDITION, edition_path, report_problems


@click.command()
@click.argument("file", default=DEFAULT_EDITION)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def ids(file: str, as_json: bool) -> None:
    """List which command ids of the edition FILE are used, by which commands, and which are free.

    The edition is not checked, so that ids can be chosen while it is being written.
    """
    with report_problems():
        edition = build_edition(edition_path(file), Path.cwd())
    users: dict[int, list[str]] = {}
    for command in edition.commands:
        users.setdefault(command.id, []).append(command.name)
    width = edition.frame.command_number.width
    free = list(_between(sorted(users), 256**width))
    if as_json:
        used = [{"id": id, "commands": users[id]} for id in sorted(users)]
        spans = [{"first": first, "last": last} for first, last in free]
        click.echo(json.dumps({"edition": edition.name, "used": used, "free": spans}))
        return
    for id in sorted(users):
        click.echo(f"{id:#0{2 + 2 * width}x}  {', '.join(users[id])}")
    shown = (dict.fromkeys(f"{end:#0{2 + 2 * width}x}" for end in span) for span in free)
    words = f"free: {', '.join('..'.join(ends) for ends in shown) or 'none'}"
    click.echo(fill(words, 80, subsequent_indent="      "))


def _between(used: Iterable[int], end: int) -> Iterator[tuple[int, int]]:
    """Yield the first and last of each run of ids that no command uses."""
    first = 0
    for id in (*used, end):
        if first < id:
            yield first, id - 1
        first = id + 1
