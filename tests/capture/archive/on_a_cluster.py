"""Further tests of archives on a Dask cluster; ``make archives`` runs them."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import dask
import pytest
from distributed import Client

from capture.archive.captures import (
    archive_in,
    counts,
    noisy_stream,
    on_one_machine,
    plan,
    rows,
)
from capture.archive.dask_processes import DaskProcesses
from capture.archive.test_s3 import check_object_store
from cobotwire.capture import archive
from cobotwire.capture.archive import DaskEngine
from cobotwire.capture.export import Inputs
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import LinkError
from command_line import run_program

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads open files from /proc")


def test_dataframe_and_delayed_tables_hold_the_rows_of_one_machine(
    cluster: DaskProcesses, tmp_path: Path
) -> None:
    inputs = archive_in(tmp_path)
    scan = archive.scan(
        [input.url for input in inputs.files], InstalledEditions(), "get_angles", piece_bytes=12_000
    )
    expected = scan.to_arrow()
    with Client(cluster.address):
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
    engine = DaskEngine(cluster.address)
    assert scan.report(engine) == scan.report()


def test_archive_in_an_object_store_is_read_and_written_there(
    cluster: DaskProcesses, bucket: str, tmp_path: Path
) -> None:
    check_object_store(f"{bucket}/cluster", tmp_path, DaskEngine(cluster.address))


def test_task_that_kills_each_worker_is_an_error(cluster: DaskProcesses, tmp_path: Path) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(1500))
    inputs = Inputs.find([str(path)])
    out = tmp_path / "out"
    cluster.forgive(0)

    def kill_once(size: int) -> None:
        if len(cluster.pids) > 1:
            cluster.kill_a_writer()

    try:
        with pytest.raises(LinkError, match="every worker that had this task died"):
            archive.export(
                plan(out),
                inputs,
                DaskEngine(cluster.address),
                piece_bytes=2000,
                progress=kill_once,
            )
    finally:
        cluster.forgive(3)
    # The other worker removes what it was still writing.
    deadline = time.monotonic() + 60
    while list(out.rglob("*.parquet")):
        assert time.monotonic() < deadline, "files of a failed export remain"
        time.sleep(0.05)


def test_error_on_a_cluster_has_the_same_text_as_on_one_machine(
    cluster: DaskProcesses, tmp_path: Path
) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(100))
    inputs = Inputs.find([str(path)])
    path.write_bytes(b"")
    engine = DaskEngine(cluster.address)
    with pytest.raises(
        LinkError, match=r"arm.bin: it ends at byte \d+ instead of \d+: did it chan"
    ):
        archive.export(plan(tmp_path / "out"), inputs, engine, piece_bytes=1000)


@pytest.mark.parametrize("scheduler", [True, False], ids=["its cluster", "own cluster"])
def test_command_line_exports_on_a_cluster(
    cluster: DaskProcesses, tmp_path: Path, scheduler: bool
) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(300))
    one = on_one_machine(tmp_path / "one", Inputs.find([str(path)]))
    words = ["--scheduler", cluster.address] if scheduler else ["--workers", "1"]
    out = tmp_path / "many"
    words += ["--engine", "dask", "--json", "--direction", "reply", "-o", str(out)]
    found = run_program("export", path, *words)
    assert (found.returncode, found.stderr) == (1, "")
    report = json.loads(found.stdout)
    del report["files"]
    assert report == counts(one)
    assert rows(out) == rows(tmp_path / "one")
