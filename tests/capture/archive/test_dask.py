"""Archives on a Dask cluster of processes over TCP; one test kills a process.

``make archives`` also runs the tests of ``on_a_cluster.py``, which take longer.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from capture.archive.captures import counts, noisy_stream, on_one_machine, plan, rows
from capture.archive.dask_processes import DaskProcesses
from cobotwire.capture import archive
from cobotwire.capture.archive import DaskEngine, dask_engine
from cobotwire.capture.export import Inputs
from cobotwire.protocol.errors import LinkError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads open files from /proc")


def test_killed_worker_changes_nothing_in_the_result(
    cluster: DaskProcesses, tmp_path: Path
) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(1500))
    inputs = Inputs.find([str(path)])
    one = on_one_machine(tmp_path / "one", inputs)
    out = tmp_path / "many"
    attempts: list[int] = []

    def kill_once(size: int) -> None:
        if not attempts:
            cluster.kill_a_writer()
        attempts.append(len([path for path in out.glob(".cobotwire-*/*") if path.is_dir()]))

    engine = DaskEngine(cluster.address)
    many = archive.export(plan(out), inputs, engine, piece_bytes=2000, progress=kill_once)
    assert len(cluster.pids) == 1
    assert max(attempts) > len(attempts), "another attempt took the place of the killed one"
    assert counts(many) == counts(one)
    assert rows(out) == rows(tmp_path / "one")
    assert len(many.files) == len([file for file in out.rglob("*") if file.is_file()])


def test_scheduler_that_does_not_answer_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dask_engine, "CONNECT_SECONDS", 1)
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(10))
    inputs = Inputs.find([str(path)])
    engine = DaskEngine("tcp://127.0.0.1:1")
    with pytest.raises(LinkError, match=r"tcp://127\.0\.0\.1:1: no Dask scheduler answers"):
        archive.export(plan(tmp_path / "out"), inputs, engine)
    assert not list((tmp_path / "out").rglob("*"))
