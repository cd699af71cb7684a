"""The client logs through the standard ``logging``, and prints nothing by default."""

from __future__ import annotations

import logging

import pytest

from both_ways import Opener
from cobotwire import LinkError, ReplyTimeout
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
