"""Extract and build a revision of the project, so that a bench can run it with other trees."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
PLACE = ROOT / "target" / "compare"
MODULE = Path("python", "cobotwire", "_native.abi3.so")


class NoBuildError(Exception):
    """A revision that cannot be built; the text says why."""


def built(revision: str) -> Path:
    """Return the folder of a revision with its native module; extract and build what is missing.

    Raises:
        NoBuildError: git does not know the revision, or cargo cannot build it.
    """
    tree = extracted(revision)
    if not (tree / MODULE).exists():
        _build(tree)
    return tree


def working_tree() -> Path:
    """Return the folder of the working tree.

    Raises:
        NoBuildError: its native module is missing.
    """
    if not (ROOT / MODULE).exists():
        raise NoBuildError("the working tree has no native module: run make .venv/.native")
    return ROOT


def extracted(revision: str) -> Path:
    """Return the folder with the files of a revision; it has the name of its commit.

    Raises:
        NoBuildError: git does not know the revision.
    """
    commit = _output("git", "rev-parse", "--verify", "--short=12", f"{revision}^{{commit}}")
    tree = PLACE / commit.strip()
    if tree.exists():
        return tree
    partial = tree.with_suffix(".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    archive = PLACE / f"{tree.name}.tar"
    _output("git", "archive", "--output", str(archive), commit.strip())
    with tarfile.open(archive) as files:
        files.extractall(partial, filter="tar")
    archive.unlink()
    partial.rename(tree)
    return tree


def _build(tree: Path) -> None:
    target = PLACE / "build"
    environment = {**os.environ, "CARGO_TARGET_DIR": str(target), "PYO3_PYTHON": sys.executable}
    command = ["cargo", "build", "--release", "--quiet", "--package", "cobotwire-native"]
    command += ["--features", "pyo3/extension-module"]
    ended = subprocess.run(command, cwd=tree, env=environment)
    if ended.returncode:
        raise NoBuildError(f"cargo could not build {tree.name}; its messages are above")
    libraries = [target / "release" / f"lib_native.{suffix}" for suffix in ("so", "dylib")]
    shutil.copyfile(next(each for each in libraries if each.exists()), tree / MODULE)


def _output(*command: str) -> str:
    ended = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if ended.returncode:
        raise NoBuildError(f"{' '.join(command)}: {ended.stderr.strip()}")
    return ended.stdout
