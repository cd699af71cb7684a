"""Archives on a Dask cluster: processes over TCP, an S3 server, and workers that are killed."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import dask
import pytest
from distributed import Client, LocalCluster

from archive.captures import archive_in, counts, noisy_stream, on_one_machine, plan, rows
from cobotwire import archive
from cobotwire.archive import DaskEngine, dask_engine
from cobotwire.capture.export import Inputs
from cobotwire.protocol.errors import LinkError


def test_killed_workers_change_nothing_in_the_result(cluster: LocalCluster, tmp_path: Path) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(1500))
    inputs = Inputs.find([str(path)])
    one = on_one_machine(tmp_path / "one", inputs)
    out = tmp_path / "many"
    killed: set[int] = set()
    attempts = 0

    def kill(size: int) -> None:
        """Kill all workers with SIGKILL, at a moment when one of them is writing a file."""
        nonlocal attempts
        attempts = max(attempts, len(list(out.glob(".cobotwire-*/*"))))
        if killed:
            return
        workers = {worker.process.pid for worker in cluster.workers.values()}
        deadline = time.monotonic() + 60
        while not killed:
            assert time.monotonic() < deadline, "no worker writes"
            _signal(workers, signal.SIGSTOP)
            if list(out.rglob("*.cobotwire-tmp")):
                killed.update(workers)
            _signal(workers, signal.SIGKILL if killed else signal.SIGCONT)

    engine = DaskEngine(cluster.scheduler_address)
    many = archive.export(plan(out), inputs, engine, piece_bytes=2000, progress=kill)
    pieces = -(-path.stat().st_size // 2000)
    assert len(killed) == 2
    assert attempts > pieces, "another attempt took the place of the killed one"
    assert counts(many) == counts(one)
    assert rows(out) == rows(tmp_path / "one")
    assert len(many.files) == len([file for file in out.rglob("*") if file.is_file()])


def test_task_that_kills_each_worker_is_an_error(cluster: LocalCluster, tmp_path: Path) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(1500))

    def kill(size: int) -> None:
        """Kill a worker; the scheduler gives up on the tasks that it had."""
        if cluster.scheduler.allowed_failures:
            cluster.scheduler.allowed_failures = 0
            os.kill(next(iter(cluster.workers.values())).process.pid, signal.SIGKILL)

    engine = DaskEngine(cluster.scheduler_address)
    usual = cluster.scheduler.allowed_failures
    inputs = Inputs.find([str(path)])
    try:
        with pytest.raises(LinkError, match="every worker that had this task died"):
            archive.export(plan(tmp_path / "out"), inputs, engine, piece_bytes=2000, progress=kill)
    finally:
        cluster.scheduler.allowed_failures = usual
    # The other worker removes what it was still writing.
    deadline = time.monotonic() + 60
    while list((tmp_path / "out").rglob("*.parquet")):
        assert time.monotonic() < deadline, "files of a failed export remain"
        time.sleep(0.05)


def _signal(pids: set[int], number: int) -> None:
    for pid in pids:
        os.kill(pid, number)


def test_dataframe_and_delayed_tables_hold_the_rows_of_one_machine(
    cluster: LocalCluster, tmp_path: Path
) -> None:
    inputs = archive_in(tmp_path)
    scan = archive.scan([input.url for input in inputs.files], "get_angles", piece_bytes=12_000)
    expected = scan.to_arrow()
    with Client(cluster.scheduler_address):
        frame = scan.dataframe()
        assert frame.npartitions == len(scan.pieces) > 7
        assert frame.compute()["j1"].tolist() == expected.column("j1").to_pylist()
        assert frame.groupby("robot")["j1"].count().compute().sort_index().to_dict() == {
            "arm1": 2000,
            "arm2": 50,
            "arm4": 200,
            "arm5": 150,
        }
        tables = dask.compute(*scan.delayed())
        assert sum(table.num_rows for table in tables) == expected.num_rows == 2400
    engine = DaskEngine(cluster.scheduler_address)
    assert scan.report(engine) == scan.report()


def test_archive_in_an_object_store_is_read_and_written_there(
    cluster: LocalCluster, bucket: str, tmp_path: Path
) -> None:
    import s3fs

    store = s3fs.S3FileSystem()
    (tmp_path / "day").mkdir()
    local = archive_in(tmp_path / "day")
    store.put(str(tmp_path / "day"), f"{bucket}/raw/", recursive=True)
    inputs = Inputs.find([f"{bucket}/raw"])
    one = on_one_machine(tmp_path / "one", local)
    many = archive.export(
        plan(f"{bucket}/out"),
        inputs,
        DaskEngine(cluster.scheduler_address),
        piece_bytes=12_000,
    )
    assert counts(many) == counts(one)
    store.invalidate_cache()
    names = store.find(f"{bucket}/out")
    assert sorted(f"s3://{name}" for name in names) == sorted(file.path for file in many.files)
    store.get(f"{bucket}/out/", str(tmp_path / "many"), recursive=True)
    found, expected = rows(tmp_path / "many"), rows(tmp_path / "one")
    assert found.keys() == expected.keys()
    for message, table in found.items():
        # The inputs have other names there.
        assert table.drop_columns("source") == expected[message].drop_columns("source")


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
    assert not (tmp_path / "out").exists()


def test_error_of_a_worker_is_that_of_one_machine(cluster: LocalCluster, tmp_path: Path) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(100))
    inputs = Inputs.find([str(path)])
    path.write_bytes(b"")
    engine = DaskEngine(cluster.scheduler_address)
    with pytest.raises(
        LinkError, match=r"arm.bin: it ends at byte \d+ instead of \d+: did it chan"
    ):
        archive.export(plan(tmp_path / "out"), inputs, engine, piece_bytes=1000)
