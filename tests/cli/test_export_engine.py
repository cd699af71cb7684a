"""``cobotwire export --engine``, as a user starts it; Dask: capture/archive/on_a_cluster.py."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from capture.archive.captures import noisy_stream
from in_process import cobotwire


@pytest.fixture
def capture(tmp_path: Path) -> str:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(300))
    return str(path)


def test_threads_write_numbered_files_and_report_the_same_counts(
    capture: str, tmp_path: Path
) -> None:
    one = cobotwire("export", capture, "-o", str(tmp_path / "one"), "--json")
    many = cobotwire(
        "export", capture, "-o", str(tmp_path / "many"), "--json", "--engine", "threads"
    )
    assert (many.returncode, many.stderr) == (one.returncode, one.stderr) == (1, "")
    expected, found = _counts(one.stdout), _counts(many.stdout)
    assert found == expected
    part = tmp_path / "many" / "get_angles.reply-00000.parquet"
    assert pq.ParquetFile(part).metadata.num_rows == 300


def _counts(report: str) -> dict[str, Any]:
    return {key: value for key, value in json.loads(report).items() if key != "files"}


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--scheduler", "tcp://127.0.0.1:1"], "a scheduler needs a Dask cluster"),
        (["--workers", "2"], "--workers needs --engine threads or --engine dask"),
        (
            ["--engine", "dask", "--scheduler", "tcp://127.0.0.1:1", "--workers", "2"],
            "the cluster has its own workers",
        ),
        (["--output", "memory://out"], "only an export with --engine can write there"),
    ],
)
def test_options_that_do_not_fit_are_refused(
    capture: str, tmp_path: Path, words: list[str], sentence: str
) -> None:
    output = [] if "--output" in words else ["-o", str(tmp_path / "out")]
    found = cobotwire("export", capture, *output, *words)
    assert found.returncode == 2
    assert sentence in found.stderr
    assert not (tmp_path / "out").exists()
