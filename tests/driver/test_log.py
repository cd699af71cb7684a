"""What the standard ``logging`` is told; and that a program that asks for nothing hears nothing."""

from __future__ import annotations

import logging
import subprocess
import sys

import pytest

from both_ways import Opener
from cobotwire import LinkError, ReplyTimeout
from scripted_peer import ScriptedPeer

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
SERVO_LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def test_frames_noise_silence_and_the_link_are_logged(
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
    said = [(record.levelname, record.getMessage()) for record in caplog.records]
    assert said[:4] == [
        ("INFO", f"{url}: opened"),
        ("DEBUG", f"{url} > FE FE 02 20 FA"),
        ("INFO", f"{url} < noise (no-header) FF FF 01 04 02 38 02 BE"),
        ("DEBUG", f"{url} < {ANGLES.hex(' ').upper()} (answered)"),
    ]
    assert ("INFO", f"{url}: no answer to is_power_on, asked 1 x") in said
    assert said[-1][0] == "WARNING"


def test_nothing_is_printed_unless_it_is_asked_for() -> None:
    program = (
        "from cobotwire import MyCobot, LinkError\n"
        "import sys\n"
        "try:\n"
        "    with MyCobot(sys.argv[1], timeout=0.1) as arm:\n"
        "        arm.get_angles(); arm.get_angles()\n"
        "except LinkError:\n"
        "    pass\n"
    )
    with ScriptedPeer([SERVO_LEAK + ANGLES], [None]) as peer:
        result = subprocess.run(
            [sys.executable, "-c", program, peer.url], capture_output=True, text=True, check=True
        )
    assert result.stdout == result.stderr == ""
