"""Finds this project's spec, and lists the files that are generated from it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path, PurePosixPath

from cobotwire_codegen.build import Built, build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target
from cobotwire_codegen.errors import Place, Problem, SpecError
from cobotwire_codegen.facts import SOURCES, Sources, bar, confirmed, counts, facts_of_pages
from cobotwire_codegen.language.reference import language_page
from cobotwire_codegen.language.schema import schema_json
from cobotwire_codegen.library import Library, build_library, render_library, render_page
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.render import (
    Files,
    render_python,
    render_reference,
    with_used_types,
)
from cobotwire_codegen.render.robot_page import robot_pages
from cobotwire_codegen.render.sharing import Sharing
from cobotwire_codegen.render.unit_module import render_clients, render_units
from cobotwire_codegen.suite_pages import suite_pages
from cobotwire_codegen.targets.c import render_c
from cobotwire_codegen.targets.decoder import render_decoder
from cobotwire_codegen.targets.rust import render_every_rust
from cobotwire_codegen.targets.typescript import render_every_typescript
from cobotwire_codegen.targets.vectors import render_shared_vectors
from cobotwire_codegen.targets.wireshark import render_wireshark

# Not an edition of an arm: no client is generated from it.
SERVO_BUS = "spec/servo_bus.yaml"


def editions(root: Path) -> list[Edition]:
    """Return every edition of the spec, checked.

    Raises:
        SpecError: the spec is wrong, or has no edition.
    """
    built: Built = {}
    found = [build_edition(path, root, built=built) for path in edition_files(root)]
    for edition in found:
        check(edition)
    return found


def edition_files(root: Path) -> list[Path]:
    """Return the edition files of a project.

    Raises:
        SpecError: the project has no edition file.
    """
    paths = sorted((root / "spec" / "editions").glob("*.yaml"))
    if not paths:
        place = Place(str(root / "spec" / "editions"), 1, 1)
        message = "there is no edition here; run this in the project, or pass --root"
        raise SpecError([Problem(place, "no-edition", message)])
    return paths


def spec_files(root: Path) -> list[Path]:
    """Return the edition files of a project, and the file of the servo bus if it has one.

    Raises:
        SpecError: the project has no edition file.
    """
    bus = root / SERVO_BUS
    return edition_files(root) + [bus] * bus.exists()


# The editions with a committed reference: newcomers and reviewers of a change of the spec read it.
REVIEWED = ("mycobot", "mycobot280")


def committed(root: Path, found: list[Edition]) -> list[Target]:
    """Return the generated files that git tracks: what pip installs, and what reviewers read."""
    package = root / "python" / "cobotwire" / "editions"
    sharings = _sharings(found)
    made = []
    for edition in found:
        base = sharings.get(edition.base)
        made.append(Target(package / edition.name, render_python(edition, base=base)))
        if edition.name in REVIEWED:
            made.append(Target(root / REFERENCE / edition.name, render_reference(edition)))
    clients = {PurePosixPath("clients.py"): render_clients(found)}
    made.append(Target(package, clients, alone=False))
    if library := _library(root, found):
        folder = root / "python" / "cobotwire" / "pymycobot"
        made.append(Target(folder, render_library(library), alone=False))
    made += _servo_bus(root)
    units = {PurePosixPath("units.json"): render_units()}
    made.append(Target(root / "python" / "cobotwire" / "protocol", units, alone=False))
    return made


def _library(root: Path, found: Sequence[Edition]) -> Library | None:
    """Return the classes with the maker's names; None if the project does not state them."""
    path = root / "spec" / "pymycobot.yaml"
    return build_library(path, root, [*found]) if path.is_file() else None


def second_sources(root: Path, found: Sequence[Edition]) -> dict[str, Sources]:
    """Return what the maker's library and pages confirm of each edition.

    What confirms a command of the base also confirms it in an edition that inherits it unchanged.
    If the library has a class for the edition, only that class counts.
    """
    library, pages = _in_library(root, found), root / "spec" / "public_pages.txt"
    stated = facts_of_pages(pages.read_text(encoding="utf-8")) if pages.is_file() else {}
    made: dict[str, Sources] = {}
    editions = {edition.name: edition for edition in found}

    def of(edition: Edition) -> Sources:
        if edition.name not in made:
            base = editions.get(edition.base)
            above = of(base) if base else Sources()
            before = base.by_name if base else {}
            same = {each.name for each in edition.commands if before.get(each.name) == each}
            made[edition.name] = Sources(
                library.get(edition.name, above.library & same),
                frozenset(stated.get(edition.name, ()))
                | {fact for fact in above.pages if fact.partition("/")[0] in same},
            )
        return made[edition.name]

    return {edition.name: of(edition) for edition in found}


def confirmed_table(root: Path, found: Sequence[Edition]) -> str:
    """Return a Markdown table: for each edition, the shares of facts that each source confirms.

    The last column counts the facts that no source confirms.
    """
    sources = second_sources(root, found)
    rows = [
        "| edition | facts | " + " | ".join(SOURCES) + " | no source |",
        "|---|--:|" + "---|" * len(SOURCES) + "--:|",
    ]
    for edition in found:
        counted = counts(confirmed(edition, sources[edition.name]))
        bars = " | ".join(bar(counted[source], counted["facts"]) for source in SOURCES)
        shown = f"{counted['facts']} | {bars} | {counted['none']}"
        rows.append(f"| `{edition.name}` | {shown} |")
    return "\n".join(rows)


def _in_library(root: Path, found: Sequence[Edition]) -> dict[str, frozenset[str]]:
    """Return the commands that the maker's library has, for each edition with a class there."""
    library = _library(root, found)
    names: dict[str, frozenset[str]] = {}
    for each in library.classes if library else ():
        sent = {method.command.name for method in each.methods}
        for edition in (each.edition, each.elsewhere):
            names[edition.name] = names.get(edition.name, frozenset()) | sent
    return names


def _servo_bus(root: Path) -> list[Target]:
    """Return the table with which the diagnosis of noise reads packets of the servo bus."""
    path = root / SERVO_BUS
    if not path.exists():
        return []
    bus = build_edition(path, root)
    check(bus)
    files = {PurePosixPath("edition.json"): edition_json(bus)}
    folder = root / "python" / "cobotwire" / "diagnose" / "servo_bus"
    return [Target(folder, files, alone=False)]


def _every_c(found: Sequence[Edition]) -> Files:
    made: Files = {}
    for edition in found:
        made |= {edition.name / path: text for path, text in render_c(edition).items()}
    return made


def _reference(root: Path, found: Sequence[Edition]) -> Files:
    """Return all generated pages of the docs site, including the committed ones."""
    made = {PurePosixPath("language.md"): language_page()}
    for edition in found:
        made |= {edition.name / path: text for path, text in render_reference(edition).items()}
    if library := _library(root, found):
        made |= render_page(library)
    return made | suite_pages(root)


def _robots(root: Path, found: Sequence[Edition]) -> Files:
    """Return the page of each robot."""
    sources = second_sources(root, found)
    return robot_pages([(each, confirmed(each, sources[each.name])) for each in found])


RUST_EDITIONS = "rust/client/src/editions"
TYPESCRIPT_EDITIONS = "clients/typescript/editions"
REFERENCE = "docs/reference"
ROBOTS = "docs/robots"
# What docs/conf.py writes before it builds the site.
SITE = (REFERENCE, ROBOTS, "docs/_static/decoder/editions")
# Build products by their folder. Git ignores them; users generate the ones that they need.
PRODUCTS: dict[str, Callable[[Path, Sequence[Edition]], Files]] = {
    REFERENCE: _reference,
    ROBOTS: _robots,
    "docs/_static/decoder/editions": lambda _, found: render_decoder(found),
    RUST_EDITIONS: lambda _, found: render_every_rust(found),
    TYPESCRIPT_EDITIONS: lambda _, found: render_every_typescript(found),
    "targets/c": lambda _, found: _every_c(found),
    "targets/vectors": lambda _, found: render_shared_vectors(found),
    "targets/wireshark": lambda _, found: render_wireshark(found),
}


def products(root: Path, found: list[Edition], folders: Iterable[str] = PRODUCTS) -> list[Target]:
    """Return the generated files that git ignores: pages of the site, output targets, test data.

    Raises:
        SuiteError: the pages of the test suite cannot be made.
    """
    return [Target(root / folder, PRODUCTS[folder](root, found)) for folder in folders]


def _sharings(found: list[Edition]) -> dict[str, Sharing]:
    """Return what each edition shares with its base; bases come first."""
    made: dict[str, Sharing] = {}
    left = {edition.name: edition for edition in found}
    while left:
        ready = [name for name, edition in left.items() if edition.base not in left]
        for name in ready:
            edition = left.pop(name)
            made[name] = Sharing(with_used_types(edition), made.get(edition.base))
    return made


def schema_target(root: Path, found: list[Edition]) -> Target:
    """Return the schema for editors, which is written next to the files that it describes."""
    files = {PurePosixPath("schema.json"): schema_json(found)}
    return Target(root / "spec", files, alone=False)
