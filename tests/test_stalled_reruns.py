"""A failed test runs again only if the machine stalled; a test that fails in each run has
failed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import vectors

TESTS = '''
import os, signal, subprocess, sys, time
import pytest

RUNS = []
# Stops this process several times for some seconds, as stalls of the machine do.
STALL = """
import os, signal, sys, time
pid, times, seconds = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
for _ in range(times):
    os.kill(pid, signal.SIGSTOP)
    time.sleep(seconds)
    os.kill(pid, signal.SIGCONT)
    time.sleep(0.05)
"""


@pytest.fixture(scope="module")
def shared():
    return []


def stall(times=1, seconds=0.5):
    words = [str(os.getpid()), str(times), str(seconds)]
    subprocess.run([sys.executable, "-c", STALL, *words], check=True)


def test_first_run_is_late(shared):
    shared.append(1)
    RUNS.append("late")
    if len(shared) == 1:
        stall()
        raise AssertionError("too late")


def test_first_run_is_late_by_many_short_stalls(shared):
    shared.append(1)
    RUNS.append("slow")
    if len(shared) == 3:
        stall(6, 0.12)
        raise AssertionError("too late")


def test_each_run_fails_in_a_stall():
    RUNS.append("stalls")
    stall()
    raise AssertionError("wrong")


def test_fails_without_a_stall():
    RUNS.append("wrong")
    raise AssertionError("wrong")


def test_runs():
    assert RUNS == ["late"] * 2 + ["slow"] * 2 + ["stalls"] * 3 + ["wrong"]
'''


def test_failed_test_runs_again_only_after_a_stall(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(
        "from stalled_reruns import pytest_runtest_protocol, pytest_terminal_summary\n"
    )
    (tmp_path / "test_it.py").write_text(TESTS)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_it.py"]
    path = str(vectors.ROOT / "tests")
    ended = subprocess.run(
        command, cwd=tmp_path, env={"PYTHONPATH": path}, capture_output=True, text=True
    )
    assert "2 failed, 3 passed" in ended.stdout, ended.stdout
    assert ended.stdout.count("run again, because the machine stalled: test_it.py::") == 4
