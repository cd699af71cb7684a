"""The probe, built from the Rust sources that it tests."""

from __future__ import annotations

import json
import shutil
import subprocess
from functools import lru_cache
from typing import Any

import pytest

from vectors import ROOT

needed = pytest.mark.skipif(shutil.which("cargo") is None, reason="cargo is not installed")


@lru_cache
def path() -> str:
    """Build the probe once; return the path of the program."""
    subprocess.run(["cargo", "build", "--quiet", "-p", "cobotwire-probe"], cwd=ROOT, check=True)
    return str(ROOT / "target/debug/cobotwire-probe")


class Probe:
    """The probe in one of its modes, which has the given arguments."""

    def __init__(self, mode: str, *arguments: str) -> None:
        self._process = subprocess.Popen(
            [path(), mode, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def ask(self, question: Any) -> Any:
        """Return the answer to a line."""
        source, target = self._process.stdout, self._process.stdin
        assert source is not None
        assert target is not None
        target.write(json.dumps(question) + "\n")
        target.flush()
        return json.loads(source.readline())

    def close(self) -> None:
        """End the process."""
        self._process.communicate()
