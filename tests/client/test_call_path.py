"""One call runs code of few files of the package, so that a reader can follow it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import FrameType
from typing import Any

import cobotwire
from cobotwire.editions.mycobot280 import MyCobot280

PACKAGE = str(Path(cobotwire.__file__).parent)
MOST_FILES = 17
# Runs in a separate process, so that its code is not counted.
SIMULATOR = """
import sys
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
with PtyServer(SimulatedArm(TABLE)) as server:
    print(server.url, flush=True)
    sys.stdin.read()
"""


def test_get_angles_runs_code_of_at_most_17_files() -> None:
    files: set[str] = set()

    def note(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(PACKAGE):
            files.add(str(Path(frame.f_code.co_filename).relative_to(PACKAGE)))

    command = [sys.executable, "-c", SIMULATOR]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as simulator:
        assert simulator.stdin is not None
        assert simulator.stdout is not None
        url = simulator.stdout.readline().strip()
        # A second attempt runs more files. On a slow machine, the first one needs this much time.
        with MyCobot280(url, codec="native", timeout=10) as arm:
            # The first call also imports modules; later calls do not.
            arm.get_angles()
            sys.setprofile(note)
            try:
                arm.get_angles()
            finally:
                sys.setprofile(None)
        simulator.stdin.close()
    assert "client/connection.py" in files
    assert len(files) <= MOST_FILES, "\n".join(sorted(files))
