"""Real servers for the tests of archives: an S3 server, and a Dask cluster of processes."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from capture.archive.dask_processes import DaskProcesses

CREDENTIALS = {
    "AWS_ACCESS_KEY_ID": "test",
    "AWS_SECRET_ACCESS_KEY": "test",
    "AWS_DEFAULT_REGION": "us-east-1",
}


@pytest.fixture(scope="package")
def bucket(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Start an S3 server as a process; yield the URL of a bucket. Workers inherit its address."""
    log = tmp_path_factory.mktemp("s3") / "log"
    command = [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", "0"]
    with log.open("w") as output, subprocess.Popen(command, stderr=output) as server:
        try:
            with pytest.MonkeyPatch.context() as patch:
                patch.setenv("AWS_ENDPOINT_URL", _address(log, server))
                for name, value in CREDENTIALS.items():
                    patch.setenv(name, value)
                import s3fs

                s3fs.S3FileSystem().mkdir("captures")
                yield "s3://captures"
        finally:
            server.kill()


def _address(log: Path, server: subprocess.Popen[bytes]) -> str:
    deadline = time.monotonic() + 60
    while not (found := re.search(r"http://[\d.:]+", log.read_text())):
        assert server.poll() is None, log.read_text()
        assert time.monotonic() < deadline, "the S3 server does not start"
        time.sleep(0.05)
    return found[0]


@pytest.fixture(scope="package")
def processes(bucket: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaskProcesses]:
    """Start a Dask scheduler, which is reached over TCP."""
    started = DaskProcesses(tmp_path_factory.mktemp("dask"))
    try:
        yield started
    finally:
        started.stop()


@pytest.fixture
def cluster(processes: DaskProcesses) -> DaskProcesses:
    """Return the cluster with all workers running; restart those that an earlier test killed."""
    processes.replace_killed_workers()
    return processes
