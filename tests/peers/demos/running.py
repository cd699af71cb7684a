"""Run a demo on a simulated robot, and tell how it ended."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cobotwire.editions import load
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm, TcpServer
from demos.scripts import Demo

SHIM = Path(__file__).parent / "shim"
# Demos that loop for ever are ended after so many seconds; the robot is as much faster.
LONGEST, RATE = 12.0, 20.0
WITH_LIBRARY = ("-W", "ignore")
WITH_LAYER = ("-m", "cobotwire.pymycobot", "--errors", "return")


@contextmanager
def robot(edition: str) -> Iterator[dict[str, str]]:
    """Serve a simulated robot, and yield the environment that leads a program to it."""
    arm = SimulatedArm(load(edition).TABLE, clock=RunningClock(RATE), powered=True)
    with PtyServer(arm) as pty, TcpServer(lambda: arm) as tcp:
        yield {
            **os.environ,
            "DEMO_PORT": pty.url,
            "DEMO_TCP": tcp.url.rpartition(":")[2],
            "PYTHONPATH": os.pathsep.join([str(SHIM), os.environ.get("PYTHONPATH", "")]),
            "PYTHONDONTWRITEBYTECODE": "1",
        }


def outcome(demo: Demo, folder: Path, how: tuple[str, ...]) -> str:
    """Run a demo; return ``runs``, ``runs on`` if it loops, or the last line of its traceback."""
    script = folder / demo.path
    command = [sys.executable, *how, str(script), *demo.arguments]
    with robot(demo.edition) as environment, subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
        text=True, cwd=script.parent, env=environment,
    ) as program:  # fmt: skip
        try:
            _, errors = program.communicate(demo.typed, timeout=LONGEST)
        except subprocess.TimeoutExpired:
            program.send_signal(signal.SIGINT)
            try:
                _, errors = program.communicate(timeout=LONGEST)
            except subprocess.TimeoutExpired:
                program.kill()
                return "does not end after Ctrl-C"
            return "runs on" if _interrupted(errors) else _last(errors)
    return "runs" if program.returncode == 0 else _last(errors)


def _interrupted(errors: str) -> bool:
    return "Traceback" not in errors or errors.rstrip().endswith("KeyboardInterrupt")


def _last(errors: str) -> str:
    lines = [line for line in errors.splitlines() if line.strip()]
    return lines[-1][:100] if lines else "ends with an error"
