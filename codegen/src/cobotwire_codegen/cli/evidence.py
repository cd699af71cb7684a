"""``cobotwire-gen evidence``: add to the spec what real arms showed; list what is unconfirmed."""

from __future__ import annotations

import json
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from textwrap import fill

import click

from cobotwire_codegen.author.append import appended, built_with
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.cli.shared import report_problems, report_write_errors, root_option
from cobotwire_codegen.diff import diff, report
from cobotwire_codegen.diff.waivers import apply_waivers
from cobotwire_codegen.errors import nearest
from cobotwire_codegen.evidence.entry import Entry, checked, text_of
from cobotwire_codegen.evidence.submitted import NotEvidence, Submitted, read_submitted
from cobotwire_codegen.facts import (
    NO_SOURCES,
    SOURCES,
    Confirmed,
    bar,
    confirmed,
    counts,
    unconfirmed,
)
from cobotwire_codegen.model import Edition
from cobotwire_codegen.project import edition_files, editions, second_sources
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.render import with_used_types

_WIDTH = 80
_MOST_REFUSED = 10
_edition_option = click.option(
    "--edition-file",
    type=click.Path(exists=True, dir_okay=False),
    help="The edition, if it is not one of spec/editions.",
)


@click.group()
def evidence() -> None:
    """Add to the spec what a real arm showed, and list what no arm has confirmed."""


@evidence.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
@_edition_option
@click.option("--dry-run", is_flag=True, help="Write nothing; only show what would change.")
@root_option
def add(file: str, edition_file: str | None, dry_run: bool, root: str) -> None:
    """Add FILE, a survey or a conformance report, to the evidence of its edition.

    FILE is what `cobotwire survey` or `cobotwire conform device --json` wrote. It becomes one YAML
    file in the folder evidence, which the edition then names. Its frames become vectors. A fact
    that it contradicts becomes disputed; confirming a disputed fact raises the confidence in it.

    FILE need not be trusted: sizes, names, values and frames are checked. A fact is accepted only
    if its frames are in the recording. A confirmed fact must have frames of its command.

    Exit codes: 0 success; 2 FILE or the spec is wrong, and nothing was written.
    """
    try:
        given = read_submitted(Path(file))
        path = Path(edition_file) if edition_file else _of_project(Path(root), given.edition)
        with report_problems(), report_write_errors():
            before = build_edition(path, Path.cwd())
            entry = checked(before, given)
            folder = path.parent.parent if path.parent.name == "editions" else path.parent
            home = folder / "evidence" / f"{given.edition}-{given.day}-{given.digest[:8]}.yaml"
            name = home.relative_to(folder).as_posix()
            named = f"../{name}" if folder != path.parent else name
            own = path.read_text(encoding="utf-8")
            changed = appended(own, str(path), "evidence", [f"- {named}"], False)
            texts = {home: text_of(given, entry), path: changed}
            after = built_with(path, texts)
            check(after)
            if not dry_run:
                home.parent.mkdir(exist_ok=True)
                for place, text in texts.items():
                    place.write_text(text, encoding="utf-8")
    except (NotEvidence, OSError) as error:
        raise click.UsageError(f"{file}: {error}") from error
    _show(home, before, after, given, entry)


def _of_project(root: Path, name: str) -> Path:
    with report_problems():
        found = {path.stem: path for path in edition_files(root)}
    if name not in found:
        raise click.UsageError(f"there is no edition {name}{nearest(name, found)}")
    return found[name]


def _show(home: Path, before: Edition, after: Edition, given: Submitted, entry: Entry) -> None:
    left = [len(unconfirmed(confirmed(edition))) for edition in (before, after)]
    good = sum(fact.confirmed for fact in entry.taken)
    click.echo(f"{home}")
    click.echo(
        f"{good} facts confirmed, {len(entry.taken) - good} contradicted, {len(entry.vectors)} "
        f"vectors; not confirmed by any arm: {left[0]} facts before, {left[1]} now"
    )
    if given.table not in ("", sha256(edition_json(with_used_types(before)).encode()).hexdigest()):
        click.echo("The arm was compared with another version of the edition.")
    for name, reason in list(entry.refused.items())[:_MOST_REFUSED]:
        click.echo(f"not accepted: {name}: {reason}")
    if len(entry.refused) > _MOST_REFUSED:
        click.echo(f"not accepted: {len(entry.refused) - _MOST_REFUSED} more")
    for _, line in report.text(apply_waivers(diff(before, after), ())):
        click.echo(line)


@evidence.command("list")
@click.argument("names", metavar="[EDITION]...", nargs=-1)
@_edition_option
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@root_option
def list_(names: tuple[str, ...], edition_file: str | None, as_json: bool, root: str) -> None:
    """List the facts of each EDITION that no arm has confirmed; without EDITION, count for all.

    A fact counts as confirmed by an arm if a public capture or an owner's survey shows it. Facts
    that the maker's library or pages confirm are counted separately.
    """
    with report_problems():
        if edition_file:
            known = [build_edition(Path(edition_file), Path.cwd())]
        else:
            known = editions(Path(root))
    for name in names:
        if name not in {each.name for each in known}:
            hint = nearest(name, (each.name for each in known))
            raise click.UsageError(f"there is no edition {name}{hint}")
    sources = {} if edition_file else second_sources(Path(root), known)
    found = {
        each.name: confirmed(each, sources.get(each.name, NO_SOURCES))
        for each in known
        if each.name in names or not names
    }
    if as_json:
        listed = {name: _plain(each) for name, each in found.items()}
        click.echo(json.dumps({"format": "cobotwire-evidence", "version": 1, **listed}, indent=1))
        return
    for name, each in found.items():
        click.echo("\n".join(_counted(name, each)))
        if names or edition_file:
            click.echo("\n".join(_listed(each)))


def _plain(found: Confirmed) -> dict[str, object]:
    return {
        "counts": counts(found),
        "facts": {name: sorted(sources) for name, sources in found.items()},
    }


def _counted(name: str, found: Confirmed) -> Iterator[str]:
    counted = counts(found)
    yield f"{name}: {counted['facts']} facts"
    for source in (*SOURCES, "none"):
        yield f"  {source:8} {bar(counted[source], counted['facts']):16} {counted[source]:5}"


def _listed(found: Confirmed) -> Iterator[str]:
    """Yield the facts that no arm has confirmed: a paragraph for each command."""
    commands: dict[str, dict[str, list[str]]] = {}
    missing = unconfirmed(found)
    for fact in missing:
        _, command, part, aspect = fact.split("/")
        commands.setdefault(command, {}).setdefault(part, []).append(aspect)
    yield f"No arm has confirmed {len(missing)} facts of {len(commands)} commands:"
    for command, parts in commands.items():
        shown = "; ".join(f"{part}: {', '.join(aspects)}" for part, aspects in parts.items())
        yield fill(
            f"{command} ({sum(map(len, parts.values()))}): {shown}",
            _WIDTH,
            initial_indent="  ",
            subsequent_indent="    ",
            break_on_hyphens=False,
        )
