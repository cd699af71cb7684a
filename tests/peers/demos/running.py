"""Run a demo on a simulated robot, and tell how it ended."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from cobotwire.editions import load
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm, TcpServer
from demos.scripts import Demo

SHIM = Path(__file__).parent / "shim"
# Demos that loop for ever are ended after so many seconds; the robot is as much faster.
LONGEST, RATE = 14.0, 20.0
# How long a program may take to end after Ctrl-C.
LEAVING = 5.0
# When the first key is pressed, and how long it is until the next one.
FIRST_KEY, NEXT_KEY = 5.0, 0.7
WITH_LIBRARY = ("-W", "ignore")
WITH_LAYER = ("-m", "cobotwire.pymycobot", "--errors", "return")
RUNS, RUNS_ON = "runs", "runs on"


class Outcome(NamedTuple):
    """How a demo ended: ``runs``, ``runs on`` if it loops, or its exception; and its last line."""

    word: str
    detail: str = ""


@contextmanager
def robot(edition: str) -> Iterator[dict[str, str]]:
    """Serve a simulated robot, and yield the environment that leads a program to it."""
    arm = SimulatedArm(load(edition).TABLE, clock=RunningClock(RATE), powered=True)
    with PtyServer(arm) as served, TcpServer(lambda: arm) as tcp:
        yield {
            **os.environ,
            "DEMO_PORT": served.url,
            "DEMO_TCP": tcp.url.rpartition(":")[2],
            "MPLBACKEND": "Agg",
            "PYTHONPATH": os.pathsep.join([str(SHIM), os.environ.get("PYTHONPATH", "")]),
            "PYTHONDONTWRITEBYTECODE": "1",
        }


class Terminal:
    """A terminal in which a person types what a demo asks for."""

    def __init__(self, demo: Demo) -> None:
        self._demo = demo
        self._ours, self.theirs = pty.openpty()
        self._shown = bytearray()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def type_all(self) -> None:
        """Type all lines at once; press the keys one after another, in a thread."""
        os.write(self._ours, self._demo.typed.encode())
        if self._demo.keys:
            threading.Thread(target=self._press, daemon=True).start()

    def last_line(self) -> str:
        """Return the last line that the demo wrote."""
        lines = self._shown.decode(errors="replace").splitlines()
        return next((line.strip("= ") for line in reversed(lines) if line.strip()), "")

    def close(self) -> None:
        """Close both ends."""
        os.close(self.theirs)
        self._reader.join(1.0)
        os.close(self._ours)

    def _press(self) -> None:
        wait = FIRST_KEY
        for key in self._demo.keys:
            time.sleep(wait)
            wait = NEXT_KEY
            try:
                os.write(self._ours, key.encode())
            except OSError:
                return

    def _read(self) -> None:
        try:
            while data := os.read(self._ours, 4096):
                self._shown += data
        except OSError:
            # The other end is closed.
            return


def outcome(demo: Demo, folder: Path, how: tuple[str, ...]) -> Outcome:
    """Run a demo, and return how it ended."""
    script = folder / demo.path
    program = [str(SHIM / "tested.py"), str(script)] if demo.is_test else [str(script)]
    terminal = Terminal(demo)
    try:
        with robot(demo.edition) as environment, subprocess.Popen(
            [sys.executable, *how, *program], stdin=terminal.theirs, stdout=terminal.theirs,
            stderr=subprocess.PIPE, text=True, cwd=script.parent, env=environment,
        ) as running:  # fmt: skip
            terminal.type_all()
            found = _ended(running)
    finally:
        terminal.close()
    return Outcome(terminal.last_line()) if demo.is_test and found.word == RUNS else found


def _ended(running: subprocess.Popen[str]) -> Outcome:
    try:
        _, errors = running.communicate(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        running.send_signal(signal.SIGINT)
        try:
            _, errors = running.communicate(timeout=LEAVING)
        except subprocess.TimeoutExpired:
            running.kill()
            _, errors = running.communicate()
        return Outcome(RUNS_ON) if _interrupted(errors) else _last(errors)
    well = running.returncode == 0 and not _raised(errors)
    return Outcome(RUNS) if well else _last(errors)


def _raised(errors: str) -> bool:
    """Return whether a thread ended with an exception."""
    return "Traceback (most recent call last)" in errors


def _interrupted(errors: str) -> bool:
    return not _raised(errors) or errors.rstrip().endswith("KeyboardInterrupt")


def _last(errors: str) -> Outcome:
    """Return the exception of which the last line of a traceback tells."""
    lines = [line for line in errors.splitlines() if re.match(r"[\w.]+(Error|Exception)\b", line)]
    if not lines:
        return Outcome("ends with an error", errors[-200:])
    return Outcome(lines[-1].partition(":")[0].rpartition(".")[2], lines[-1])
