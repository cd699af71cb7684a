"""``cobotwire-gen new-command``: add a command and its first vectors to the spec."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import click

from cobotwire_codegen.author.append import appended, built_with
from cobotwire_codegen.author.draft import (
    Direction,
    Draft,
    command_lines,
    read,
    vector_lines,
)
from cobotwire_codegen.author.place import families, vectors_file
from cobotwire_codegen.author.propose import typical_values
from cobotwire_codegen.check import check as check_edition
from cobotwire_codegen.cli.shared import DEFAULT_EDITION, edition_path, report_problems
from cobotwire_codegen.errors import nearest
from cobotwire_codegen.language.words import BUILT_IN, SAFETY
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, parse
from cobotwire_codegen.model import Command, Edition, Variant
from cobotwire_codegen.wire import build_frame

_ASKED_EFFECT = (
    "What it does: {stores: STATE}, {reports: STATE}, {sets: {STATE: VALUE}}, {moves: PART, ...}"
)
_NEEDED = {
    "name": "The method's name",
    "id": "The id, such as 0x7E",
    "title": "A heading",
    "doc": "What it does, in a sentence",
    "safety": f"Its safety class ({', '.join(SAFETY)})",
}


@click.command("new-command")
@click.option("--edition", "file", default=DEFAULT_EDITION, show_default=True)
@click.option("--family", help="The family; needed if the edition has several.")
@click.option("--name", help="The method's name.")
@click.option("--id", help="The id, such as 0x7E.")
@click.option("--title", help="A heading.")
@click.option("--doc", help="What it does, in a sentence.")
@click.option("--safety", help=f"One of: {', '.join(SAFETY)}.")
@click.option("--request", help="The request's fields, as NAME:TYPE,NAME:TYPE.")
@click.option(
    "--reply",
    help="The reply's fields, in the same form; NAME:TYPE:echo repeats a field of the request.",
)
@click.option("--vector", help="A captured request, in hex.")
@click.option("--reply-vector", help="A captured reply, in hex.")
@click.option("--values", help="Values for the request's vector, as 'NAME: VALUE, NAME: VALUE'.")
@click.option("--reply-values", help="Values for the reply's vector.")
@click.option(
    "--effect",
    help="What it does, as in the spec: {stores: fan_speed}. A state that is new is declared with "
    "the type of its field.",
)
@click.option("--start", help="The value of a new state at the start.")
@click.option("--source", default="", help="Lines of the document, such as 20-39.")
@click.option("--dry-run", is_flag=True, help="Print the YAML and write nothing.")
def new_command(file: str, dry_run: bool, **given: str | None) -> None:
    """Add a command to an edition, with a vector for each of its messages.

    On a terminal, missing options are prompted for. The vectors contain the given frames, else
    frames with the given values, else frames with values that would show a mistake. The result is
    checked before anything is written; if it has problems, the files stay unchanged.
    """
    path = edition_path(file)
    with report_problems():
        homes = families(path)
        _complete(given, homes)
        draft = _draft(given)
        home, target = homes[given["family"] or ""], vectors_file(path)
        text = home.read_text(encoding="utf-8")
        changed = {home: appended(text, str(home), "commands", command_lines(draft), True)}
        declared = list(_new_states(draft, built_with(path, {}), given["start"]))
        if declared:
            text = changed.get(path) or path.read_text(encoding="utf-8")
            changed[path] = appended(text, str(path), "state", declared, False)
        vectors = list(_vectors(built_with(path, changed), draft, given))
        for lines in vectors:
            text = changed.get(target) or target.read_text(encoding="utf-8")
            changed[target] = appended(text, str(target), "vectors", lines, False)
        check_edition(built_with(path, changed))
    if dry_run:
        _show(home, command_lines(draft))
        if declared:
            _show(path, declared)
        _show(target, [line for lines in vectors for line in lines])
        return
    for place, text in changed.items():
        place.write_text(text, encoding="utf-8")
        click.echo(f"wrote {place}")


def _show(path: Path, lines: list[str]) -> None:
    click.echo(f"# {path}")
    for line in lines:
        click.echo(f"  {line}")


def _complete(given: dict[str, str | None], homes: dict[str, Path]) -> None:
    """Prompt for missing options, or raise an error if there is no terminal."""
    needed = dict(_NEEDED)
    if list(homes) == [""]:
        given["family"] = ""
    else:
        needed = {"family": f"The family ({', '.join(homes)})", **needed}
    missing = [word for word in needed if given[word] is None]
    if missing and not sys.stdin.isatty():
        raise click.UsageError(f"missing: {', '.join(f'--{word}' for word in missing)}")
    for word in missing:
        given[word] = click.prompt(needed[word])
    if missing:
        for word in ("request", "reply"):
            if given[word] is None:
                given[word] = click.prompt(f"Fields of the {word}, NAME:TYPE,...", default="")
        if given["effect"] is None:
            given["effect"] = click.prompt(_ASKED_EFFECT, default="")
    family = given["family"] or ""
    if family not in homes:
        raise click.UsageError(f"there is no family {family}{nearest(family, homes)}")
    if given["safety"] not in SAFETY:
        safety = given["safety"] or ""
        raise click.UsageError(f"--safety cannot be {safety}{nearest(safety, SAFETY)}")


def _draft(given: dict[str, str | None]) -> Draft:
    words = {word: given[word] or "" for word in given}
    try:
        id = int(words["id"], 0)
    except ValueError:
        raise click.UsageError(f"--id must be a number such as 0x7E, not {words['id']}") from None
    if not words["name"].isidentifier():
        raise click.UsageError(f"--name must be a method's name, not {words['name']!r}")
    return Draft(
        words["name"],
        id,
        words["title"],
        words["doc"],
        words["safety"],
        words["source"],
        _fields("request", words["request"]),
        _fields("reply", words["reply"]),
        words["effect"],
    )


def _new_states(draft: Draft, edition: Edition, start: str | None) -> Iterator[str]:
    """Yield the declaration of each new state that a draft stores or reports."""
    node = parse(draft.effect or "{}", "--effect")
    entries = node.entries if isinstance(node, Mapping) else {}
    types = {name: type for name, type, echo in (*draft.request, *draft.reply) if not echo}
    indices = [str(item) for item in _listed(entries.get("at"))]
    others = [name for name in types if name not in indices]
    known = {*BUILT_IN, *(state.name for state in edition.states)}
    for verb in ("stores", "reports"):
        stated = entries.get(verb)
        if isinstance(stated, Mapping):
            pairs = [(name, str(_plain(state))) for name, state in stated.entries.items()]
        else:
            pairs = [(name, str(_plain(stated))) for name in others[:1] if stated is not None]
        for name, state in pairs:
            if state not in known and name in types:
                each = f", each: [{', '.join(types[i] for i in indices if i in types)}]"
                begins = f", start: {start}" if start else ""
                yield f"{state}: {{type: {types[name]}{each if indices else ''}{begins}}}"


def _listed(node: Node | None) -> tuple[object, ...]:
    if node is None:
        return ()
    found = _plain(node)
    return found if isinstance(found, tuple) else (found,)


def _fields(flag: str, text: str) -> tuple[tuple[str, str, bool], ...]:
    found = []
    for part in filter(None, (part.strip() for part in text.split(","))):
        name, _, rest = part.partition(":")
        type, _, echo = rest.partition(":")
        if not name or not type or echo not in ("", "echo") or (echo and flag == "request"):
            raise click.UsageError(f"--{flag} must be NAME:TYPE,NAME:TYPE; {part} is not NAME:TYPE")
        found.append((name, type, bool(echo)))
    return tuple(found)


def _vectors(edition: Edition, draft: Draft, given: dict[str, str | None]) -> Iterator[list[str]]:
    """Return the lines of a vector for each variant of each message, including acknowledgements."""
    command = next(command for command in edition.commands if command.name == draft.name)
    flags: tuple[tuple[Direction, str, str], ...] = (
        ("request", "vector", "values"),
        ("reply", "reply_vector", "reply_values"),
    )
    for direction, captured, listed in flags:
        for which, variant in enumerate(command.variants(direction)):
            try:
                # A given frame is the full variant.
                frame = bytes.fromhex(given[captured] or "") if not which else b""
                values = _values_of(edition, command, direction, variant, frame, given[listed])
                built = build_frame(edition.frame, command, direction, values)
            except ValueError as error:
                raise click.UsageError(f"the {direction}'s vector: {error}") from None
            name = f"{draft.name.replace('_', '-')}-{direction}{f'-{which + 1}' if which else ''}"
            seen = bool(frame)
            yield vector_lines(name, draft.name, direction, built, values, draft.source, seen)


def _values_of(
    edition: Edition,
    command: Command,
    direction: Direction,
    variant: Variant,
    frame: bytes,
    listed: str | None,
) -> dict[str, object]:
    """Return a vector's values: of the captured frame, or as listed, or typical ones."""
    if frame:
        return read(edition, command, direction, frame)
    values = typical_values(edition, command, variant)
    values.update(_values(listed) if listed and variant == command.variants(direction)[0] else {})
    return values


def _values(text: str) -> dict[str, object]:
    node = parse(f"{{{text}}}", "--values")
    entries = node.entries if isinstance(node, Mapping) else {}
    return {name: _plain(value) for name, value in entries.items()}


def _plain(node: Node) -> object:
    if isinstance(node, Sequence):
        return tuple(_plain(item) for item in node.items)
    value = node.value if isinstance(node, Scalar) else None
    return int(value) if isinstance(value, Fraction) and value.denominator == 1 else value
