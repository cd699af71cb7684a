"""Run a Dask scheduler and its workers as processes that a test may kill."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from distributed import Client

WORKERS = 2


class DaskProcesses:
    """A scheduler on a free port, and workers with one thread each."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._log = (folder / "log").open("w")
        file = folder / "scheduler.json"
        self._scheduler = self._start("scheduler", "--port", "0", "--scheduler-file", str(file))
        self._workers: list[subprocess.Popen[bytes]] = []
        while not file.exists() or not file.read_text().endswith("}"):
            assert self._scheduler.poll() is None, (folder / "log").read_text()
            time.sleep(0.05)
        self.address: str = json.loads(file.read_text())["address"]

    def _start(self, program: str, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.dask_{program}", "--host", "127.0.0.1"]
        command += ["--no-dashboard", *words]
        return subprocess.Popen(command, stdout=self._log, stderr=self._log, cwd=self._folder)

    @property
    def pids(self) -> list[int]:
        """The process ids of the workers that live."""
        return [worker.pid for worker in self._workers if worker.poll() is None]

    def replace_killed_workers(self) -> None:
        """Start workers for those that were killed; wait until all run."""
        self._workers = [worker for worker in self._workers if worker.poll() is None]
        words = self.address, "--no-nanny", "--nthreads", "1"
        while len(self._workers) < WORKERS:
            self._workers.append(self._start("worker", *words))
        with Client(self.address) as client:
            client.wait_for_workers(WORKERS, timeout=120)

    def kill_a_writer(self) -> None:
        """Kill a worker with SIGKILL while it is writing a file of an export."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            for pid in self.pids:
                os.kill(pid, signal.SIGSTOP)
                if _writes(pid):
                    return self._kill(pid)
                os.kill(pid, signal.SIGCONT)
        raise AssertionError("no worker writes")

    def _kill(self, pid: int) -> None:
        os.kill(pid, signal.SIGKILL)
        next(worker for worker in self._workers if worker.pid == pid).wait(60)

    def forgive(self, failures: int) -> None:
        """Let the scheduler run a task again after up to ``failures`` of its workers have died."""

        def change(dask_scheduler: Any) -> None:
            dask_scheduler.allowed_failures = failures

        with Client(self.address) as client:
            client.run_on_scheduler(change)

    def stop(self) -> None:
        """Stop all processes."""
        for process in [*self._workers, self._scheduler]:
            process.kill()
            process.wait(60)
        self._log.close()


def _writes(pid: int) -> bool:
    """Return whether a process has a temporary file of an export open."""
    try:
        files = [os.readlink(path) for path in Path(f"/proc/{pid}/fd").iterdir()]
    except FileNotFoundError:
        return False
    return any(file.endswith(".cobotwire-tmp") for file in files)
