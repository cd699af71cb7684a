"""Clients send what other clients send, accept what real arms report, and reject the impossible."""

from __future__ import annotations

import time
from typing import Any

import pytest

from cobotwire import UsageError, editions
from cobotwire.simulator import PtyServer, SimulatedArm
from scripted_peer import ScriptedPeer

BOTH_EDITIONS = pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
BOTH_CODECS = pytest.mark.parametrize("codec", ["reference", "native"])


@BOTH_EDITIONS
@BOTH_CODECS
def test_send_coords_writes_mode_2_and_rejects_mode_3(edition: str, codec: Any) -> None:
    target = [150.3, -68.7, 101.8, 10.18, 0, -90]
    with ScriptedPeer() as peer:
        arm: Any
        with editions.load(edition).CLIENT(peer.url, codec=codec) as arm:
            arm.send_coords(target, 10, 2)
            with pytest.raises(UsageError, match=r"mode is 3; .*UNEXPLAINED \(2\)"):
                arm.send_coords(target, 10, 3)
            arm.stop()
        expected = bytes.fromhex("FEFE1025 05DFFD5103FA03FA0000DCD8 0A02FA FEFE0229FA")
        ends = time.monotonic() + 2
        while peer.received != expected and time.monotonic() < ends:
            time.sleep(0.01)
        assert peer.received == expected


@BOTH_EDITIONS
def test_simulated_arm_moves_to_a_target_of_mode_2(edition: str) -> None:
    package = editions.load(edition)
    with PtyServer(SimulatedArm(package.TABLE)) as server:
        arm: Any
        with package.CLIENT(server.url) as arm:
            arm.power_on()
            arm.send_coords([150, -60, 250, 180, 0, -90], 80, 2)
            assert arm.is_moving()
