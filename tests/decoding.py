"""Run ``cobotwire decode``, and write a capture for it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import in_process
from cobotwire.cli.app import app
from cobotwire.simulator.faults import noise
from command_line import PROGRAM
from diagnosing import ANGLES, FRAME, READ

COMMAND = [*PROGRAM, "decode"]
FIELD = FRAME + READ + ANGLES + b"cmd_len error\r\n" + noise.PANIC + bytes(277) + FRAME + b"\x78"


def run(*words: str, stdin: bytes | None = None, cwd: Path | None = None) -> tuple[int, str, str]:
    """Run ``cobotwire decode``: in a separate process if it reads standard input, otherwise in this
    one."""
    if stdin is None:
        done = in_process.run(app, "cobotwire", "decode", *words, folder=cwd)
        return done.returncode, done.stdout, done.stderr
    result = subprocess.run([*COMMAND, *words], input=stdin, capture_output=True, timeout=120)
    assert b"Traceback" not in result.stderr
    return result.returncode, result.stdout.decode(), result.stderr.decode()


def capture_in(folder: Path) -> str:
    """Write a file with frames and all kinds of noise; return its path."""
    path = folder / "capture.bin"
    path.write_bytes(FIELD)
    return str(path)
