"""Check what ``mypy --strict`` and pyright accept and reject in code that uses the API."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from mypy import api

import vectors

HERE = Path(__file__).parent
# A pyright that pip installs together with its Node.js; it downloads nothing at run time.
PYRIGHT = Path(sys.executable).with_name("basedpyright")
Checker = Callable[[Path], tuple[str, set[int]]]


def mypy(path: Path) -> tuple[str, set[int]]:
    """Return what mypy prints about a file, and the lines with errors."""
    config = str(vectors.ROOT / "pyproject.toml")
    # Not the cache of the linter, which may run at the same time.
    cache = str(vectors.ROOT / "target" / "mypy-of-tests")
    out, err, _ = api.run(["--strict", "--config-file", config, "--cache-dir", cache, str(path)])
    assert not err
    return out, {int(line) for line in re.findall(rf"{path.name}:(\d+): error", out)}


def pyright(path: Path) -> tuple[str, set[int]]:
    """Return what pyright prints about a file, and the lines with errors."""
    if not PYRIGHT.exists():
        pytest.skip("basedpyright is not installed; it is in the dependency group test")
    settings = {
        "include": [str(path)],
        "extraPaths": [str(vectors.ROOT / "python")],
        "typeCheckingMode": "standard",
        "pythonVersion": "3.11",
        # _call and _send have the types that the generated methods rely on.
        "reportPrivateUsage": False,
    }
    config = path.parent / f"pyright-{path.stem}.json"
    config.write_text(json.dumps(settings))
    try:
        command = [str(PYRIGHT), "--project", str(config), "--outputjson"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    finally:
        config.unlink()
    found = json.loads(done.stdout)["generalDiagnostics"]
    errors = [each for each in found if each["severity"] == "error"]
    return done.stdout, {each["range"]["start"]["line"] + 1 for each in errors}


@pytest.mark.parametrize("check", [mypy, pyright])
@pytest.mark.parametrize("name", ["right.py", "messages_right.py"])
def test_correct_code_has_no_type_error(name: str, check: Checker) -> None:
    out, errors = check(HERE / name)
    assert not errors, out


@pytest.mark.parametrize("check", [mypy, pyright])
@pytest.mark.parametrize("name", ["wrong.py", "messages_wrong.py"])
def test_exactly_the_wrong_lines_are_type_errors(name: str, check: Checker) -> None:
    out, errors = check(HERE / name)
    lines = (HERE / name).read_text().splitlines()
    assert errors == {n for n, line in enumerate(lines, 1) if line.endswith("# wrong")}, out
