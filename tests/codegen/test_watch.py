"""``cobotwire-gen watch`` generates again when a file of the spec changes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import vectors
from codegen.author import samples

SECONDS = 60.0


def until(path: Path, text: str) -> None:
    ends = time.monotonic() + SECONDS
    while time.monotonic() < ends:
        if path.exists() and text in path.read_text():
            return
        time.sleep(0.05)
    raise AssertionError(f"{text!r} is not in {path}")


def test_watch_generates_again_and_survives_a_broken_spec(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    lamp, package, log = folder / "lamp.yaml", folder / "made", folder / "log"
    text = lamp.read_text()
    command = [sys.executable, "-m", "cobotwire_codegen", "watch", str(lamp), "--out", str(package)]
    environment = {**os.environ, "PYTHONPATH": str(vectors.ROOT / "codegen" / "src")}
    with (
        log.open("w") as output,
        subprocess.Popen(
            command, cwd=folder, stdout=output, stderr=subprocess.STDOUT, env=environment
        ) as watch,
    ):
        try:
            until(log, "watching ")
            until(package / "__init__.py", "GENERATED")
            lamp.write_text(text.replace("safety: query", "safety: qery"))
            until(log, "unknown-word")
            lamp.write_text(text.replace("title: ", "title: New ", 1))
            until(package / "edition.json", "New ")
            watch.send_signal(signal.SIGINT)
            assert watch.wait(SECONDS) == 0
        finally:
            # A shell starts background jobs with SIGINT ignored, and the program inherits that.
            watch.kill()
    assert "Traceback" not in log.read_text()
