"""Run mypy and pyright on files, and return the lines with errors."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from vectors import ROOT

# The name of the file, the line, and the message.
Errors = list[tuple[str, int, str]]
# A pyright that pip installs together with its Node.js; it downloads nothing at run time.
PYRIGHT = Path(sys.executable).with_name("basedpyright")
SETTINGS = {
    "extraPaths": [str(ROOT / "python")],
    "typeCheckingMode": "standard",
    "pythonVersion": "3.11",
    # These comments are for mypy.
    "enableTypeIgnoreComments": False,
    # _call and _send have the types that the generated methods rely on.
    "reportPrivateUsage": False,
}


def mypy(folder: Path, files: Sequence[Path], *options: str) -> Errors:
    """Return what ``mypy --strict`` with some options reports about files of a folder."""
    command = [sys.executable, "-m", "mypy", "--strict", "--output", "json", *options]
    done = subprocess.run(
        [*command, *(path.name for path in files)],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
    )
    assert not done.stderr
    found = map(json.loads, done.stdout.splitlines())
    return [
        (Path(each["file"]).name, each["line"], each["message"])
        for each in found
        if each["severity"] == "error"
    ]


def pyright(folder: Path, files: Sequence[Path], *_: str) -> Errors:
    """Return what pyright reports about files of a folder."""
    if not PYRIGHT.exists():
        pytest.skip("basedpyright is not installed; it is in the dependency group test")
    config = folder / "pyright-of-tests.json"
    config.write_text(json.dumps({"include": [path.name for path in files], **SETTINGS}))
    try:
        command = [str(PYRIGHT), "--project", str(config), "--outputjson"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    finally:
        config.unlink()
    found = json.loads(done.stdout)
    assert found["summary"]["filesAnalyzed"] == len(files), done.stdout
    return [
        (Path(each["file"]).name, each["range"]["start"]["line"] + 1, each["message"])
        for each in found["generalDiagnostics"]
        if each["severity"] == "error"
    ]


CHECKERS: dict[str, Callable[..., Errors]] = {"mypy": mypy, "pyright": pyright}
