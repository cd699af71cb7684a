"""The probe: a program that answers tests with the crates in Rust (``rust/probe``)."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent
needed = pytest.mark.skipif(shutil.which("cargo") is None, reason="needs cargo: not installed")


@lru_cache
def path(program: str = "cobotwire-probe") -> str:
    """Return the path of the probe or an example; all are compiled once for each test run."""
    # One command, since programs with other features of the dependencies would not share them.
    command = ["cargo", "build", "--quiet", "--package", "cobotwire-probe"]
    if (ROOT / "rust/client/src/editions/mycobot280.rs").exists():
        command += ["--package", "cobotwire", "--features", "cobotwire/mycobot280"]
        command += ["--bins", "--example", "first"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    target = Path(os.environ.get("CARGO_TARGET_DIR", "target"))
    return str(ROOT / target / "debug" / program)


class Probe:
    """The probe, which answers each line of steps (``rust/probe/src/main.rs``)."""

    def __init__(self) -> None:
        pipe = subprocess.PIPE
        self._process = subprocess.Popen([path()], stdin=pipe, stdout=pipe, text=True)

    def ask(self, steps: list[Any]) -> Any:
        """Return the result of each step."""
        target, source = self._process.stdin, self._process.stdout
        assert target is not None
        assert source is not None
        print(json.dumps(steps), file=target, flush=True)
        return json.loads(source.readline())

    def close(self) -> None:
        """End the process."""
        self._process.communicate()
