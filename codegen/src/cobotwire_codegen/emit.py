"""Text to files, or the question whether the files are what they should be."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from cobotwire_codegen.render import Files


@dataclass(frozen=True, slots=True)
class Target:
    """A folder that holds generated files and nothing else."""

    folder: Path
    files: Files


@dataclass(frozen=True, slots=True)
class Stale:
    """A file that is not what it should be: ``kind`` is stale, missing or left over."""

    path: Path
    kind: str
    diff: str


def write(target: Target) -> list[Path]:
    """Bring a folder up to date; gives the files that changed or went."""
    changed = []
    for stale in compare(target):
        if stale.kind == "left over":
            stale.path.unlink()
        else:
            stale.path.parent.mkdir(parents=True, exist_ok=True)
            name = stale.path.relative_to(target.folder)
            text = next(text for path, text in target.files.items() if Path(path) == name)
            stale.path.write_text(text, encoding="utf-8")
        changed.append(stale.path)
    return changed


def compare(target: Target) -> Iterator[Stale]:
    """What in a folder is stale, missing or left over."""
    for name, text in sorted(target.files.items()):
        path = target.folder / name
        if not path.is_file():
            yield Stale(path, "missing", _diff(path, "", text))
            continue
        # Bytes, not text: a file with other line ends or another encoding is stale as well.
        if path.read_bytes() != text.encode():
            found = path.read_text(encoding="utf-8", errors="replace")
            yield Stale(path, "stale", _diff(path, found, text))
    for path in sorted(target.folder.rglob("*")):
        generated = path.relative_to(target.folder).as_posix() in map(str, target.files)
        if path.is_file() and not generated and "__pycache__" not in path.parts:
            yield Stale(path, "left over", "")


def _diff(path: Path, found: str, wanted: str) -> str:
    lines = difflib.unified_diff(
        found.splitlines(keepends=True),
        wanted.splitlines(keepends=True),
        f"{path} (on disk)",
        f"{path} (generated)",
    )
    return "".join(lines)
