"""A client does not load ``logging``, and logs all the same once a program uses it."""

from __future__ import annotations

from command_line import run_code

OPEN = """
import sys
from cobotwire import LinkError, MyCobot280
class Memory:
    url = "memory"
    def write(self, data): pass
    def read(self, timeout):
        if timeout:
            raise LinkError(self.url, "is gone")
        return b""
    def close(self): pass
arm = MyCobot280(Memory())
assert "logging" not in sys.modules
"""


def _stderr_of(code: str) -> str:
    done = run_code(OPEN + code)
    return done.stderr if done.returncode == 0 else f"failed: {done.stderr}"


def test_traffic_is_logged_once_the_program_configures_logging() -> None:
    code = "import logging\nlogging.basicConfig(level=logging.DEBUG)\narm.stop()"
    assert _stderr_of(code) == "DEBUG:cobotwire.traffic:memory > FE FE 02 29 FA\n"


def test_warning_goes_nowhere_without_logging() -> None:
    code = """
try:
    arm.get_angles()
except LinkError:
    assert "logging" in sys.modules
"""
    assert _stderr_of(code) == ""
