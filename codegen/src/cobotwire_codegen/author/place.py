"""Finds the files of an edition that a new command and its vectors belong to."""

from __future__ import annotations

from pathlib import Path

from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, load


def families(edition: Path) -> dict[str, Path]:
    """Return the file of each family of commands; a protocol in one file has only the key ""."""
    commands = _under(edition, "commands")
    # A delta may have no commands of its own yet; the first one is added to its edition file.
    if commands is None or isinstance(commands, Mapping):
        return {"": edition}
    found = {}
    for path in _files(edition, commands):
        family = _under(path, "family")
        if isinstance(family, Scalar):
            found[str(family.value)] = path
    return found


def vectors_file(edition: Path) -> Path:
    """Return the file for new vectors: missing.yaml, the last vectors file or the edition file."""
    paths = _files(edition, _under(edition, "vectors"))
    named = [path for path in paths if path.name == "missing.yaml"]
    return [edition, *paths, *named][-1]


def _files(edition: Path, node: Node | None) -> list[Path]:
    items = node.items if isinstance(node, Sequence) else (node,)
    names = (item.value for item in items if isinstance(item, Scalar))
    return [edition.parent / name for name in names if isinstance(name, str)]


def _under(path: Path, key: str) -> Node | None:
    root = load(path)
    return root.entries.get(key) if isinstance(root, Mapping) else None
