"""Run a demo on a simulated robot, and report how it ended."""

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
from tempfile import TemporaryFile
from typing import IO, NamedTuple

from cobotwire.editions import load
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm, TcpServer
from demos.scripts import Demo

SHIM = Path(__file__).parent / "shim"
# A demo that loops for ever is ended after LONGEST seconds; the robot is RATE times as fast.
LONGEST, RATE = 14.0, 20.0
# Tests never loop for ever.
TESTING = 60.0
# How long a program may take to end after Ctrl-C, before it is killed.
LEAVING = 3.0
# When the first key is pressed, and how long it is until the next one.
FIRST_KEY, NEXT_KEY = 5.0, 0.7
WITH_LIBRARY = ("-W", "ignore")
WITH_LAYER = ("-m", "cobotwire.pymycobot", "--errors", "return")
RUNS, RUNS_ON = "runs", "runs on"


class Outcome(NamedTuple):
    """The end of a demo: ``runs``, ``runs on`` if it loops, or its exception; and its last line."""

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

    def counts(self) -> str:
        """Return how many tests passed and failed, as pytest says at the end."""
        return ", ".join(re.findall(r"\d+ (?:failed|passed)", self._shown.decode(errors="replace")))

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
        with robot(demo.edition) as environment, TemporaryFile("w+") as errors, subprocess.Popen(
            [sys.executable, *how, *program], stdin=terminal.theirs, stdout=terminal.theirs,
            stderr=errors, cwd=script.parent, env=environment,
        ) as running:  # fmt: skip
            terminal.type_all()
            found = _ended(running, errors, TESTING if demo.is_test else LONGEST)
    finally:
        terminal.close()
    return Outcome(terminal.counts()) if demo.is_test and found.word == RUNS else found


def _ended(running: subprocess.Popen[bytes], errors: IO[str], longest: float) -> Outcome:
    """Wait until a demo ends, or end it; ignore what it writes after that."""
    try:
        running.wait(longest)
    except subprocess.TimeoutExpired:
        found = _raised(errors) or Outcome(RUNS_ON)
        running.send_signal(signal.SIGINT)
        try:
            running.wait(LEAVING)
        except subprocess.TimeoutExpired:
            running.kill()
        return found
    well = Outcome(RUNS) if running.returncode == 0 else Outcome("ends with an error")
    return _raised(errors) or well


def _raised(errors: IO[str]) -> Outcome | None:
    """Return the last exception of a demo or of one of its threads; None if there was none."""
    errors.seek(0)
    lines = [line.rstrip() for line in errors if re.match(r"[\w.]+(Error|Exception)\b", line)]
    return Outcome(lines[-1].partition(":")[0].rpartition(".")[2], lines[-1]) if lines else None
