"""Check what ``mypy --strict`` and pyright accept and reject in code that uses the API."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

import vectors
from type_checkers import CHECKERS, Errors

HERE = Path(__file__).parent


@cache
def errors(checker: str) -> Errors:
    """Return the errors in all files: each run of a checker reads the package anew."""
    # Not the cache of the linter, which may run at the same time.
    options = (
        f"--config-file={vectors.ROOT / 'pyproject.toml'}",
        f"--cache-dir={vectors.ROOT / 'target' / 'mypy-of-tests'}",
    )
    files = [HERE / f"{name}.py" for name in ("right", "wrong", "messages_right", "messages_wrong")]
    return CHECKERS[checker](HERE, files, *options)


@pytest.mark.parametrize("checker", CHECKERS)
@pytest.mark.parametrize("name", ["right.py", "messages_right.py"])
def test_correct_code_has_no_type_error(name: str, checker: str) -> None:
    assert [each for each in errors(checker) if each[0] == name] == []


@pytest.mark.parametrize("checker", CHECKERS)
@pytest.mark.parametrize("name", ["wrong.py", "messages_wrong.py"])
def test_exactly_the_wrong_lines_are_type_errors(name: str, checker: str) -> None:
    lines = (HERE / name).read_text().splitlines()
    wrong = {n for n, line in enumerate(lines, 1) if line.endswith("# wrong")}
    assert {line for file, line, _ in errors(checker) if file == name} == wrong
