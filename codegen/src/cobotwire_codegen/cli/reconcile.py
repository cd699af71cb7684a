"""``cobotwire-gen reconcile``: find messages in a capture that the edition lacks."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import BinaryIO

import click

from cobotwire_codegen.author.reconcile import captured, draft_lines, plain
from cobotwire_codegen.author.reconcile import reconcile as reconciled
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.cli.shared import DEFAULT_EDITION, edition_path, report_problems


@click.command()
@click.argument("capture", type=click.File("rb"))
@click.option("--edition", "file", default=DEFAULT_EDITION, show_default=True)
@click.option(
    "--direction",
    type=click.Choice(("request", "reply", "both")),
    default="both",
    show_default=True,
    help="What was captured, unless CAPTURE states it: requests, replies, or both.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def reconcile(capture: BinaryIO, file: str, direction: str, as_json: bool) -> None:
    """Find the ids and lengths in CAPTURE that the edition lacks, with a draft entry for each.

    CAPTURE is a pcapng recording, raw bytes or hex text; - is standard input. The drafts are
    guesses from what the bytes look like. The exit code is 1 if anything was unknown, else 0.
    """
    try:
        line = captured(capture.read(), direction)
    except ValueError as error:
        raise click.UsageError(f"the capture cannot be read: {error}") from None
    with report_problems():
        edition = build_edition(edition_path(file), Path.cwd())
    count, found = reconciled(edition, line)
    size = sum(len(packet.data) for packet in line)
    drafts = [list(draft_lines(edition, news)) for news in found]
    if as_json:
        unknown = [plain(news, draft) for news, draft in zip(found, drafts)]
        click.echo(json.dumps({"bytes": size, "frames": count, "unknown": unknown}, indent=1))
    else:
        for draft in drafts:
            click.echo("\n".join(draft) + "\n")
        click.echo(f"{size} bytes, {count} frame(s), {len(found)} unknown variant(s)", err=True)
    sys.exit(1 if found else 0)
