"""``cobotwire-gen diff``: report what changed between two specs, and the version bump."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Literal

import click

from cobotwire_codegen.cli.shared import report_problems
from cobotwire_codegen.diff import LEVELS, RULES, Finding, diff_all, fails
from cobotwire_codegen.diff import diff as diff_two
from cobotwire_codegen.diff import report as reports
from cobotwire_codegen.diff.rules import Level
from cobotwire_codegen.diff.sources import Source, SourceError, paired, read
from cobotwire_codegen.diff.waivers import Outcome, apply_waivers, read_waivers

_COLOURS = {
    "wire": "red",
    "api": "red",
    "behaviour": "yellow",
    "peer": "yellow",
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
    help="A YAML list of {rule, where, reason}: findings that are accepted.",
)
@click.option(
    "--fail-on",
    type=click.Choice((*LEVELS, "none")),
    default="peer",
    show_default=True,
    help="The least severe level that makes the exit code 1.",
)
@click.option(
    "--format",
    type=click.Choice(("text", "json", "markdown")),
    default="text",
    show_default=True,
    help="How findings are printed; markdown is for the changelog.",
)
@click.option(
    "--rules",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_rules,
    help="List every rule with its level, and exit.",
)
def diff(
    old: str, new: str, waivers: str | None, fail_on: Level | Literal["none"], format: str
) -> None:
    """Report what changed from OLD to NEW, how severe it is, and the version bump that follows.

    OLD and NEW are each an edition file, a folder that contains spec/, or a git revision of the
    repository in the current folder (a path has precedence over a revision). If both are folders
    or revisions, editions of the same name are compared. A single file is compared with the edition
    of the same name. The specs are not checked: `cobotwire-gen check` does that.

    Findings that break the wire or the API require a major version; changes of behaviour, values
    that a peer of the other version does not know, and additions require a minor version; changes
    of docs require a patch. Before 1.0, where SemVer promises nothing, additions and docs raise the
    patch number, and all others the minor number.

    By default the exit code is 1 unless every finding is an addition or concerns docs, as a
    release requires. `--fail-on wire` or `--fail-on api` accepts changes of behaviour, such as
    another safety class, deadline or range; `--rules` lists the levels from the most severe on.

    Exit codes: 0 no finding fails; 1 a finding has the level of --fail-on or a more severe one,
    and is not waived; 2 the command line, the spec or the waivers are wrong.
    """
    with report_problems("json" if format == "json" else "text"):
        accepted = read_waivers(Path(waivers)) if waivers else ()
        try:
            findings = _compare(read(old), read(new))
        except SourceError as error:
            raise click.UsageError(str(error)) from error
    outcome = apply_waivers(findings, accepted)
    _print(outcome, old, new, format)
    sys.exit(1 if fails(outcome.findings, None if fail_on == "none" else fail_on) else 0)


def _compare(old: Source, new: Source) -> tuple[Finding, ...]:
    if old.one and new.one:
        # Two files are compared even if their editions have different names.
        [before], [after] = old.editions.values(), new.editions.values()
        return diff_two(before, after)
    return diff_all(*paired(old, new))


def _print(outcome: Outcome, old: str, new: str, format: str) -> None:
    if format == "json":
        click.echo(reports.as_json(outcome, old, new))
    elif format == "markdown":
        click.echo("\n".join(reports.markdown(outcome)))
    else:
        for kind, line in reports.text(outcome):
            click.secho(line, fg=_COLOURS.get(kind), bold=bool(kind) or None)
