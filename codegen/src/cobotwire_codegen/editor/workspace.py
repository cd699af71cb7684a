"""Builds the editions that a file belongs to, with the texts that an editor has not saved yet."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path

from cobotwire_codegen.author.append import files_of
from cobotwire_codegen.build import Built, build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.errors import Place, Problem, SpecError
from cobotwire_codegen.load import Mapping, Node, load
from cobotwire_codegen.model import Edition


class Workspace:
    """The specs in a folder, as the editor shows them."""

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()
        self.unsaved: dict[Path, str] = {}
        self._built: dict[Path, Edition] = {}

    def text(self, path: Path) -> str:
        """Return a file's text: what the editor shows, or else what is on disk."""
        path = path.resolve()
        return self.unsaved[path] if path in self.unsaved else path.read_text(encoding="utf-8")

    def path(self, place: Place) -> Path:
        """Return the file of a place."""
        return (self.root / place.file).resolve()

    def editions_of(self, path: Path) -> list[Path]:
        """Return the edition files that a file belongs to: itself, or those that name it."""
        path = path.resolve()
        if _is_edition(path):
            return [path]
        return [edition for edition in self._edition_files(path) if path in _files(edition)]

    def _edition_files(self, near: Path) -> Iterator[Path]:
        """Yield the edition files in the folders above a file, up to the root."""
        for folder in near.parents:
            for place in (folder, folder / "editions"):
                yield from filter(_is_edition, sorted(place.glob("*.yaml")))
            if folder == self.root:
                return

    def edition(self, path: Path) -> Edition | None:
        """Return the edition of a file, as built by the last attempt that succeeded."""
        for edition in self.editions_of(path):
            with suppress(SpecError):
                self._built[edition] = build_edition(edition, self.root, self.unsaved)
            if edition in self._built:
                return self._built[edition]
        return None

    def problems(self, path: Path) -> dict[Path, list[Problem]]:
        """Return the problems of a file's editions, by file; the file itself is always a key."""
        found: dict[Path, list[Problem]] = defaultdict(list)
        found[path.resolve()] = []
        built: Built = {}
        for edition in self.editions_of(path):
            for file in _files(edition):
                found.setdefault(file, [])
            for problem in self._problems_of(edition, built):
                file = self.path(problem.place)
                if problem not in found[file]:
                    found[file].append(problem)
        return found

    def _problems_of(self, edition: Path, built: Built) -> Iterable[Problem]:
        try:
            self._built[edition] = build_edition(edition, self.root, self.unsaved, built)
            check(self._built[edition])
        except SpecError as error:
            return error.problems
        return ()


def _is_edition(path: Path) -> bool:
    root = _root(path)
    return isinstance(root, Mapping) and "edition" in root.entries


def _files(edition: Path) -> set[Path]:
    try:
        return {file.resolve() for file in files_of(edition)}
    except SpecError:
        return {edition.resolve()}


def _root(path: Path) -> Node | None:
    try:
        return load(path)
    except SpecError:
        return None
