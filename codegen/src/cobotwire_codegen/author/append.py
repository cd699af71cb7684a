"""Adds entries to YAML files as text, so that comments and formatting stay as they are.

No YAML writer is used: ``load`` finds the place, and lines are inserted there.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.build.packages import names_package
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, load, parse
from cobotwire_codegen.model import Edition

_LISTED = ("frame", "types", "commands", "vectors", "errata", "changes")


def appended(text: str, name: str, key: str, entry: list[str], blank: bool) -> str:
    """Return a file's text with an entry added at the end of a top-level key.

    Raises:
        SpecError: the key's value is on one line, or is not a list or mapping.
    """
    root = parse(text, name)
    held = root.entries.get(key) if isinstance(root, Mapping) else None
    lines = text.splitlines()
    if held is None or not isinstance(root, Mapping):
        new = [f"{key}:", *(f"  {line}".rstrip() for line in entry)]
        return "\n".join([*_without_end(lines), "", *new]) + "\n"
    if isinstance(held, Scalar) or held.place.line == root.keys[key].line:
        message = f"{key} is written on one line; write one entry a line, so that more can be added"
        raise SpecError([Problem(held.place, "wrong-kind", message)])
    margin = " " * (held.place.column - 1)
    end = _end(lines, root, key)
    new = [f"{margin}{line}".rstrip() for line in entry]
    before, after = _without_end(lines[:end]), lines[end:]
    return "\n".join([*before, *([""] if blank else []), *new, *_gap(after), *after]) + "\n"


def _end(lines: list[str], root: Mapping, key: str) -> int:
    """Return the index of the first line after a key's value."""
    here = root.keys[key].line
    later = [place.line for place in root.keys.values() if place.line > here]
    if not later:
        return len(lines)
    end = min(later) - 1
    # A comment right above the next key belongs to that key.
    while lines[end - 1].startswith("#"):
        end -= 1
    return end


def _without_end(lines: list[str]) -> list[str]:
    while lines and not lines[-1].strip():
        lines = lines[:-1]
    return lines


def _gap(after: list[str]) -> list[str]:
    return [""] if after else []


def files_of(path: Path) -> Iterator[Path]:
    """Return an edition's file and every file that it names."""
    yield path
    root = load(path)
    entries = root.entries if isinstance(root, Mapping) else {}
    base = entries.get("base")
    # A base such as `cobotwire:mycobot280` is no path; files of an installed package do not change.
    if isinstance(base, Scalar) and not names_package(str(base.value)):
        yield from files_of(path.parent / str(base.value))
    for key in _LISTED:
        for name in _names(entries.get(key)):
            yield path.parent / name


def _names(node: Node | None) -> Iterator[str]:
    for item in node.items if isinstance(node, Sequence) else (node,):
        if isinstance(item, Scalar) and isinstance(item.value, str):
            yield item.value


def built_with(path: Path, changed: dict[Path, str]) -> Edition:
    """Return the edition as it would be with some files changed; nothing on disk changes.

    Raises:
        SpecError: the changed edition has problems; their places refer to the changed files.
    """
    return build_edition(path, Path.cwd(), {file.resolve(): text for file, text in changed.items()})
