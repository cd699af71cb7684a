"""The examples of the guide to columns run unchanged."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import duckdb
import pandas
import polars
import pyarrow
import pytest

ROOT = Path(__file__).parents[2]
ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")


def test_examples_of_the_columns_guide_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "capture.bin").write_bytes(b"\0" + ANGLES * 3)
    monkeypatch.chdir(tmp_path)
    used: list[Any] = []
    names: dict[str, Any] = {"use": used.append, "polars": polars, "duckdb": duckdb}
    names |= {"pyarrow": pyarrow, "pandas": pandas}
    text = (ROOT / "docs/columns.md").read_text()
    examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(examples) == 4
    for example in examples:
        exec(compile(example, "docs/columns.md", "exec"), names)
    assert names["angles"].to_numpy()["angles"].shape == (3, 6)
    assert [len(part) for part in used] == [1, 0]
