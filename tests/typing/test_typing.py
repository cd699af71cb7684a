"""Check what ``mypy --strict`` and pyright accept and reject in code that uses the API."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from mypy import api

import vectors

HERE = Path(__file__).parent
# A pyright that pip installs together with its Node.js; it downloads nothing at run time.
PYRIGHT = Path(sys.executable).with_name("basedpyright")
# All in one run, as each run reads the package anew.
FILES = [HERE / f"{name}.py" for name in ("right", "wrong", "messages_right", "messages_wrong")]
Checker = Callable[[Path], tuple[str, set[int]]]


def mypy(path: Path) -> tuple[str, set[int]]:
    """Return what mypy prints, and the lines of a file with errors."""
    out = _mypy_of_all()
    return out, {int(line) for line in re.findall(rf"\b{path.name}:(\d+): error", out)}


@cache
def _mypy_of_all() -> str:
    config = str(vectors.ROOT / "pyproject.toml")
    # Not the cache of the linter, which may run at the same time.
    cache = str(vectors.ROOT / "target" / "mypy-of-tests")
    options = ["--strict", "--config-file", config, "--cache-dir", cache]
    out, err, _ = api.run([*options, *map(str, FILES)])
    assert not err
    assert f"(checked {len(FILES)} source files)" in out
    return out


def pyright(path: Path) -> tuple[str, set[int]]:
    """Return what pyright prints, and the lines of a file with errors."""
    if not PYRIGHT.exists():
        pytest.skip("basedpyright is not installed; it is in the dependency group test")
    out = _pyright_of_all()
    found = json.loads(out)["generalDiagnostics"]
    errors = [each for each in found if each["severity"] == "error"]
    here = (each for each in errors if Path(each["file"]) == path)
    return out, {each["range"]["start"]["line"] + 1 for each in here}


@cache
def _pyright_of_all() -> str:
    settings = {
        "include": [*map(str, FILES)],
        "extraPaths": [str(vectors.ROOT / "python")],
        "typeCheckingMode": "standard",
        "pythonVersion": "3.11",
        # _call and _send have the types that the generated methods rely on.
        "reportPrivateUsage": False,
    }
    config = HERE / "pyright-of-all.json"
    config.write_text(json.dumps(settings))
    try:
        command = [str(PYRIGHT), "--project", str(config), "--outputjson"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    finally:
        config.unlink()
    assert json.loads(done.stdout)["summary"]["filesAnalyzed"] == len(FILES), done.stdout
    return done.stdout


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
