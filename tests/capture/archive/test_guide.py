"""The examples of docs/archives.md run unchanged."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import dask
import pytest

import vectors
from capture.archive.captures import noisy_stream


def test_examples_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "captures").mkdir()
    (tmp_path / "captures" / "left.bin").write_bytes(noisy_stream(300))
    (tmp_path / "captures" / "right.bin").write_bytes(noisy_stream(200, seed=2))
    monkeypatch.chdir(tmp_path)
    text = (vectors.ROOT / "docs/archives.md").read_text()
    examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(examples) == 2
    names: dict[str, Any] = {"dask": dask}
    for example in examples:
        exec(compile(example, "docs/archives.md", "exec"), names)
    assert names["table"].num_rows == names["rows"] == 500
    assert names["counts"].noise.total() > 100
    assert list(names["slowest"].index) == ["left", "right"]
