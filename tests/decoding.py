"""``cobotwire decode`` as another process, and a capture for it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from cobotwire.sim.faults import noise
from diagnosing import ANGLES, FRAME, READ

COMMAND = [sys.executable, "-c", "from cobotwire.cli import main; main()", "decode"]
FIELD = FRAME + READ + ANGLES + b"cmd_len error\r\n" + noise.PANIC + bytes(277) + FRAME + b"\x78"


def run(*words: str, stdin: bytes = b"", cwd: Path | None = None) -> tuple[int, str, str]:
    result = subprocess.run(
        [*COMMAND, *words], input=stdin, capture_output=True, timeout=120, check=False, cwd=cwd
    )
    assert b"Traceback" not in result.stderr
    return result.returncode, result.stdout.decode(), result.stderr.decode()


def capture_in(folder: Path) -> str:
    """A file with a bit of everything; its path."""
    path = folder / "capture.bin"
    path.write_bytes(FIELD)
    return str(path)
