"""Where this project keeps its spec, and where what is generated from it goes."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from cobotwire_codegen.author.schema import schema_json
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target
from cobotwire_codegen.errors import Place, Problem, SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, render_python, render_reference, render_vectors
from cobotwire_codegen.targets.c import render_c
from cobotwire_codegen.targets.construct import render_construct
from cobotwire_codegen.targets.decoder import render_decoder
from cobotwire_codegen.targets.vectors import render_shared_vectors
from cobotwire_codegen.targets.wireshark import render_wireshark


def editions(root: Path) -> list[Edition]:
    """Every edition of the spec, checked.

    Raises:
        SpecError: the spec is wrong, or there is none.
    """
    found = [build_edition(path, root) for path in edition_files(root)]
    for edition in found:
        check(edition)
    return found


def edition_files(root: Path) -> list[Path]:
    """The edition files of a project.

    Raises:
        SpecError: there is none.
    """
    paths = sorted((root / "spec" / "editions").glob("*.yaml"))
    if not paths:
        place = Place(str(root / "spec" / "editions"), 1, 1)
        raise SpecError([Problem(place, "no-edition", "there is no edition here")])
    return paths


def targets(root: Path, found: list[Edition]) -> list[Target]:
    """What is generated, and where it belongs."""
    package = root / "python" / "cobotwire" / "editions"
    reference = root / "docs" / "reference"
    data: Files = {}
    made = []
    for edition in found:
        made.append(Target(package / edition.name, render_python(edition)))
        made.append(Target(reference / edition.name, render_reference(edition)))
        made.append(Target(root / "targets" / "c" / edition.name, render_c(edition)))
        data.update(render_vectors(edition))
    made.append(Target(root / "rust" / "core" / "tests" / "data", data))
    made.append(schema_target(root, found))
    made.append(Target(root / "targets" / "vectors", render_shared_vectors(found)))
    made.append(Target(root / "targets" / "construct", render_construct(found)))
    made.append(Target(root / "docs" / "_static" / "decoder" / "tables", render_decoder(found)))
    made.append(Target(root / "targets" / "wireshark", render_wireshark(found)))
    return made


def schema_target(root: Path, found: list[Edition]) -> Target:
    """The schema for editors, beside the files that it speaks of."""
    files = {PurePosixPath("schema.json"): schema_json(found)}
    return Target(root / "spec", files, alone=False)
