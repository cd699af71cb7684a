"""Finds what the word at a position names: its explanation and its definition."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from cobotwire_codegen.author.describe import describe_command, describe_vector
from cobotwire_codegen.build.packages import names_package, packaged_edition
from cobotwire_codegen.editor.context import context_at
from cobotwire_codegen.editor.workspace import Workspace
from cobotwire_codegen.errors import Place, SpecError
from cobotwire_codegen.load import Mapping, Scalar, load
from cobotwire_codegen.model import Edition, Vector

_WORD = re.compile(r"[\w./:-]+")


def word_at(text: str, line: int, column: int) -> str:
    """Return the word at a position; lines and columns count from 0."""
    lines = text.split("\n")
    found = _WORD.finditer(lines[line]) if line < len(lines) else iter(())
    touching = (match for match in found if match.start() <= column <= match.end())
    return next((match[0].strip(".:") for match in touching), "")


def hover(workspace: Workspace, path: Path, line: int, column: int) -> str:
    """Return the explanation of a position as plain text; empty if nothing is known.

    A key is explained by its meaning, a name by its definition, and other places in a vector by the
    bytes of its frame.
    """
    text, edition = workspace.text(path), workspace.edition(path)
    word = word_at(text, line, column)
    context = context_at(text, line, column)
    if word in context.keys and not context.value_of:
        return f"{word}: {context.keys[word].doc}"
    if edition is None:
        return ""
    vector = _vector_at(workspace, edition, path, line)
    return next(_meanings(edition, word), describe_vector(edition, vector) if vector else "")


def _meanings(edition: Edition, word: str) -> Iterator[str]:
    for command in edition.commands:
        if command.name == word:
            yield describe_command(edition, command)
    for type in edition.types:
        if type.name == word:
            yield f"{type.name}: {type.doc}\n{type.span}"
    for wire in edition.wires:
        if wire.name == word:
            yield f"{wire.name}: {wire.doc}\n{wire.width} bytes, {wire.minimum}..{wire.maximum}"


def _vector_at(workspace: Workspace, edition: Edition, path: Path, line: int) -> Vector | None:
    """Return the vector that a line describes, or None."""
    path = path.resolve()
    here = [v for v in edition.vectors if workspace.path(v.place) == path]
    started = [vector for vector in here if vector.place.line <= line + 1]
    return max(started, key=lambda vector: vector.place.line, default=None)


def definition(workspace: Workspace, path: Path, line: int, column: int) -> tuple[Path, Place]:
    """Return the file and the place where the word at a position is defined.

    For a name in a delta, this may be a place in its base: the base's file, or the part that the
    delta changes or removes.

    Raises:
        LookupError: nothing of the spec has that name.
    """
    word = word_at(workspace.text(path), line, column)
    file = _file(path, word)
    if file is not None:
        return file, Place(str(file), 1, 1)
    for edition_file in _chain(workspace, path):
        edition = workspace.edition(edition_file)
        for place in _places(edition, word) if edition is not None else ():
            return workspace.path(place), place
    raise LookupError(word)


def _file(path: Path, word: str) -> Path | None:
    if names_package(word):
        try:
            return packaged_edition(word, Place(str(path), 1, 1))
        except SpecError:
            return None
    return path.parent / word if word.endswith(".yaml") and (path.parent / word).is_file() else None


def _chain(workspace: Workspace, path: Path) -> Iterator[Path]:
    """Yield the editions of a file, each followed by its bases."""
    for edition in workspace.editions_of(path):
        file: Path | None = edition
        while file is not None:
            yield file
            root = load(file)
            base = root.entries.get("base") if isinstance(root, Mapping) else None
            file = _file(file, str(base.value)) if isinstance(base, Scalar) else None


def _places(edition: Edition | None, word: str) -> Iterator[Place]:
    assert edition is not None
    named = (*edition.commands, *edition.types, *edition.wires, *edition.families)
    yield from (item.place for item in (*named, *edition.vectors) if item.name == word)
