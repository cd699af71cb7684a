"""Compare the codec of the npm package with vectors, in Node."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

import npm_package
import vectors
from targets.built import built
from targets.comparison import Comparison, ToolMissing

ROOT = vectors.ROOT
PROGRAM = Path(__file__).with_name("vectors.mjs")


@lru_cache
def package() -> Path:
    """Return the folder of the package, which is built once for each test run.

    Raises:
        ToolMissing: Node, npm, Rust or its target for WebAssembly is not installed.
    """
    if missing := npm_package.missing():
        raise ToolMissing(missing)
    return npm_package.build([*vectors.editions().values()])


def compare(edition: str) -> Comparison:
    """Run an edition's vectors."""
    table = ROOT / "python/cobotwire/editions" / edition / "edition.json"
    [found] = compare_all([(table, built("vectors") / f"{edition}.json")])
    return found


def compare_all(files: Iterable[tuple[Path, Path]]) -> list[Comparison]:
    """Run several documents of vectors, each after the table of its edition, in one process."""
    package()
    words = ("node", str(PROGRAM), *(str(path) for pair in files for path in pair))
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return [Comparison(**json.loads(line)) for line in done.stdout.splitlines()]
