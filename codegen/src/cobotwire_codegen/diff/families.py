"""Compares families of commands: pages of the reference, and their order."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.diff import prose
from cobotwire_codegen.diff.commands import matched_commands
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import match, order
from cobotwire_codegen.model import Edition, Family


def family_changes(old: Edition, new: Edition) -> Iterator[Finding]:
    """Compare all families, and which commands they contain."""
    matched = match(old.families, new.families, lambda family: family.name).further(_commands)
    for family in matched.removed:
        yield finding("family-removed", f"families/{family.name}", family.name)
    for family in matched.added:
        yield finding("family-added", f"families/{family.name}", "", family.name)
    for before, after in matched.pairs:
        where = f"families/{after.name}"
        if before.name != after.name:
            yield finding("family-renamed", where, before.name, after.name)
        yield from prose.doc(f"{where}/title", before.title, after.title)
        yield from prose.doc(where, before.doc, after.doc)
    yield from order("families", matched, lambda family: family.name)
    names = {one.name: other.name for one, other in matched_commands(old, new).pairs}
    homes = {command.name: family.name for family in new.families for command in family.commands}
    for before, after in matched.pairs:
        yield from _moved(before, after, names, homes)
    for family in matched.removed:
        yield from _moved(family, family, names, homes)


def _commands(family: Family) -> list[str]:
    return [command.name for command in family.commands]


def _moved(
    old: Family, new: Family, names: dict[str, str], homes: dict[str, str]
) -> Iterator[Finding]:
    """Report commands that moved to another family or within their family."""
    for command in old.commands:
        name = names.get(command.name, "")
        if name and homes[name] != new.name:
            yield finding("command-moved", f"commands/{name}", old.name, homes[name])
    stayed = match(old.commands, new.commands, lambda one: names.get(one.name, one.name))
    yield from order(f"families/{new.name}", stayed, lambda command: command.name)
