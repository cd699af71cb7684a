"""The generated API under ``mypy --strict``: what must and what must not type-check."""

from __future__ import annotations

import re
from pathlib import Path

from mypy import api

import vectors

HERE = Path(__file__).parent


def _mypy(path: Path) -> tuple[str, int]:
    config = str(vectors.ROOT / "pyproject.toml")
    out, err, code = api.run(["--strict", "--config-file", config, str(path)])
    assert not err
    return out, code


def test_right_code_type_checks() -> None:
    out, code = _mypy(HERE / "right.py")
    assert code == 0, out


def test_each_wrong_line_is_an_error_and_no_other_is() -> None:
    path = HERE / "wrong.py"
    out, code = _mypy(path)
    assert code == 1
    found = {int(number) for number in re.findall(r"wrong\.py:(\d+): error", out)}
    lines = path.read_text().splitlines()
    assert found == {n for n, line in enumerate(lines, 1) if line.endswith("# wrong")}
