"""The client logs through the standard ``logging``, which it does not load, and prints nothing."""

from __future__ import annotations

import logging

import pytest

from both_ways import Opener
from cobotwire import LinkError, ReplyTimeout
from command_line import run_code
from scripted_peer import ScriptedPeer

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
SERVO_LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def test_log_has_frames_noise_timeouts_and_lost_transports(
    open_arm: Opener, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG, logger="cobotwire")
    with ScriptedPeer([SERVO_LEAK + ANGLES], [], [None]) as peer:
        with open_arm(peer.url, timeout=0.1) as arm:
            arm.get_angles()
            with pytest.raises(ReplyTimeout):
                arm.is_power_on()
            with pytest.raises(LinkError):
                arm.get_coords()
        url = peer.url
    logged = [(record.levelname, record.getMessage()) for record in caplog.records]
    assert logged[:4] == [
        ("INFO", f"{url}: opened"),
        ("DEBUG", f"{url} > FE FE 02 20 FA"),
        ("INFO", f"{url} < noise (no-header) FF FF 01 04 02 38 02 BE"),
        ("DEBUG", f"{url} < {ANGLES.hex(' ').upper()} (reply)"),
    ]
    assert ("INFO", f"{url}: no reply to is_power_on, attempts: 1") in logged
    assert logged[-1][0] == "WARNING"


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
