"""``cobotwire-gen diff``: what changed between two specs, and the version bump that follows."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from cobotwire_codegen.cli.shared import problems_told
from cobotwire_codegen.diff import LEVELS, RULES, Finding, breaking, diff_all
from cobotwire_codegen.diff import diff as diff_two
from cobotwire_codegen.diff import report as reports
from cobotwire_codegen.diff.sources import Source, SourceError, paired, read
from cobotwire_codegen.diff.waivers import Judged, judge, read_waivers

_COLOURS = {
    "wire": "red",
    "api": "red",
    "behaviour": "yellow",
    "addition": "green",
    "docs": "blue",
    "waived": "cyan",
    "unused": "magenta",
}


def _show_rules(ctx: click.Context, param: click.Parameter, wanted: bool) -> None:
    del param
    if not wanted or ctx.resilient_parsing:
        return
    for level, meaning in LEVELS.items():
        click.secho(f"{level}: {meaning}", fg=_COLOURS[level])
        for rule, entry in RULES.items():
            if entry.level == level:
                click.echo(f"  {rule}: {entry.message.format(old='OLD', new='NEW')}")
    ctx.exit()


@click.command()
@click.argument("old")
@click.argument("new")
@click.option(
    "--waivers",
    type=click.Path(exists=True, dir_okay=False),
    help="A YAML list of {rule, where, reason}: findings that are answered for.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(("text", "json", "markdown")),
    default="text",
    show_default=True,
    help="How findings are told; markdown is for the changelog.",
)
@click.option(
    "--rules",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_rules,
    help="List every rule with its level, and exit.",
)
def diff(old: str, new: str, waivers: str | None, form: str) -> None:
    """Tell what changed from OLD to NEW, how severe it is, and the version bump that follows.

    OLD and NEW are each an edition file, a folder that holds spec/, or a git revision of the
    repository in the current folder (a path wins over a revision of the same name). Of two
    folders or revisions, editions of the same name are compared; beside a single file, the edition
    of its name. A spec is read, not checked: `cobotwire-gen check` does that.

    Wire- and API-breaking findings ask for a major version, behaviour and additions for a minor
    one, docs for a patch. Before 1.0 SemVer promises nothing; here what breaks or behaves otherwise
    raises the minor number, and all else the patch.

    Exit codes: 0 nothing breaks; 1 something breaks the wire or the API, and no waiver says why;
    2 the call, the spec or the waivers are wrong.
    """
    with problems_told("json" if form == "json" else "text"):
        accepted = read_waivers(Path(waivers)) if waivers else ()
        try:
            findings = _compare(read(old), read(new))
        except SourceError as error:
            raise click.UsageError(str(error)) from error
    judged = judge(findings, accepted)
    _tell(judged, old, new, form)
    sys.exit(1 if breaking(judged.findings) else 0)


def _compare(old: Source, new: Source) -> tuple[Finding, ...]:
    if old.one and new.one:
        # Two files are compared, whatever their editions are called.
        [before], [after] = old.editions.values(), new.editions.values()
        return diff_two(before, after)
    return diff_all(*paired(old, new))


def _tell(judged: Judged, old: str, new: str, form: str) -> None:
    if form == "json":
        click.echo(reports.as_json(judged, old, new))
    elif form == "markdown":
        click.echo("\n".join(reports.markdown(judged)))
    else:
        for kind, line in reports.text(judged):
            click.secho(line, fg=_COLOURS.get(kind), bold=bool(kind) or None)
