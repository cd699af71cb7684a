"""Check what pyright accepts and rejects in code that uses the API.

``make lint`` runs mypy on these files: it reports each error in a line without ``type: ignore``,
and each such comment in a line without an error.
"""

from __future__ import annotations

from pathlib import Path

from type_checkers import pyright

HERE = Path(__file__).parent


def test_exactly_the_wrong_lines_are_type_errors() -> None:
    files = sorted({*HERE.glob("*.py")} - {Path(__file__)})
    wrong = {
        (path.name, number)
        for path in files
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if line.endswith("# type: ignore")
    }
    assert {name for name, _ in wrong} == {"wrong.py"}
    assert {(name, number) for name, number, _ in pyright(HERE, files)} == wrong
