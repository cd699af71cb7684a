"""Names the mutants of all files, runs them, and knows which of them may survive."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from ruamel.yaml import YAML

from cobotwire_codegen.load import Node, load
from spec_mutants.mutants import Mutant, mutants_of
from spec_mutants.spec_files import PATHS, ROOT, Verdict, built, files, verdict_on


class Task(NamedTuple):
    """One mutant of a file, identified by its number within the file."""

    edition: str
    file: Path
    number: int
    kind: str
    name: str

    @property
    def title(self) -> str:
        """The file and the change."""
        return f"{self.file.relative_to(ROOT / 'spec').as_posix()}: {self.name}"


@lru_cache(maxsize=256)
def _mutants(edition: str, file: Path) -> tuple[Node, tuple[Mutant, ...]]:
    root = load(file, file.relative_to(ROOT).as_posix())
    return root, tuple(mutants_of(root, built(edition)))


def tasks() -> Iterator[Task]:
    """Yield every mutant of every file once, always in the same order."""
    done = set[Path]()
    for edition in PATHS:
        for file in files(edition):
            if file in done:
                continue
            done.add(file)
            for number, mutant in enumerate(_mutants(edition, file)[1]):
                yield Task(edition, file, number, mutant.kind, mutant.name)


def run(task: Task) -> Verdict:
    """Return what notices a mutant."""
    root, mutants = _mutants(task.edition, task.file)
    return verdict_on(task.edition, task.file, mutants[task.number].applied(root))


def run_all(chosen: Iterable[Task]) -> Iterator[Verdict]:
    """Yield what notices each mutant."""
    with ProcessPoolExecutor(2) as pool:
        yield from pool.map(run, chosen, chunksize=8)


@cache
def _unconfirmed() -> list[dict[str, Any]]:
    path = ROOT / "tests" / "spec_mutants" / "unconfirmed.yaml"
    rows: list[dict[str, Any]] = YAML(typ="safe").load(path.read_text())["unconfirmed"]
    return rows


def accepted(edition: str, kind: str, title: str) -> str:
    """Return why a mutant may survive; empty if it may not."""
    for row in _unconfirmed():
        named = edition in row.get("editions", [edition])
        if named and re.fullmatch(row["facts"], f"{kind} {title}"):
            return str(row["why"])
    return ""
