"""The editions of this project, the files of each, and verdicts on changed files."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import vectors
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, load
from cobotwire_codegen.model import Edition
from cobotwire_codegen.project import spec_files
from cobotwire_codegen.publish import edition_json
from spec_statements import STATEMENTS

ROOT = Path(__file__).resolve().parent.parent.parent
# The files by edition. A change may be noticed in each edition that uses the file.
PATHS = {path.stem: path for path in spec_files(ROOT)}
# The keys of texts that explain a fact, and of its place in the file.
PROSE = {"doc", "title", "notes", "place"}
FACTS = ("frame", "types", "commands", "changes")


@dataclass(frozen=True)
class Verdict:
    """What noticed a mutant, or that nothing did; ``equal`` if the edition is still the same."""

    killer: str = ""
    equal: bool = False


def files(edition: str) -> Iterator[Path]:
    """Yield the files that state the facts of an edition."""
    path = PATHS[edition]
    yield path
    root = load(path)
    assert isinstance(root, Mapping)
    for key in FACTS:
        node = root.entries.get(key)
        for item in node.items if isinstance(node, Sequence) else (node,):
            if isinstance(item, Scalar):
                yield (path.parent / str(item.value)).resolve()


@lru_cache(maxsize=len(PATHS))
def built(edition: str) -> Edition:
    """Return an unchanged edition."""
    return vectors.editions().get(edition) or build_edition(PATHS[edition], ROOT)


@lru_cache(maxsize=256)
def _users(path: Path) -> list[str]:
    """Return the editions that use a file, directly or through a base."""
    owners = {name for name in PATHS if path in files(name)}
    return [name for name in PATHS if owners & {name, *built(name).bases}]


@lru_cache(maxsize=len(PATHS))
def _built_facts(edition: str) -> object:
    return _facts(built(edition))


def _facts(edition: Edition) -> object:
    """Return what an edition states, without its prose."""
    return _without_prose(json.loads(edition_json(edition)))


def _without_prose(value: object) -> object:
    if isinstance(value, dict):
        return {key: _without_prose(item) for key, item in value.items() if key not in PROSE}
    return [_without_prose(item) for item in value] if isinstance(value, list) else value


def verdict_on(edition: str, path: Path, node: Node) -> Verdict:
    """Return what notices a change of a file of an edition."""
    equal = True
    for name in {edition: 0, **dict.fromkeys(_users(path))}:
        try:
            made = build_edition(PATHS[name], ROOT, {path: node})
            check(made)
        except SpecError as error:
            return Verdict(f"check: {error.problems[0].code}")
        if _facts(made) != _built_facts(name):
            equal = False
            for statement in STATEMENTS:
                for _ in statement(made):
                    return Verdict(
                        f"{statement.__module__.rpartition('.')[2]}.{statement.__name__}"
                    )
    return Verdict(equal=equal)
