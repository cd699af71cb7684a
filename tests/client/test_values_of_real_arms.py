"""Clients send what other clients send, accept what real arms report, and reject the impossible."""

from __future__ import annotations

import time
from typing import Any

import pytest

from cobotwire import ProtocolError, UsageError, editions
from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import MyCobot280
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


def _angles_reply(*hundredths: int) -> bytes:
    words = b"".join(value.to_bytes(2, "big", signed=True) for value in hundredths)
    return bytes.fromhex("FEFE0E20") + words + b"\xfa"


@BOTH_EDITIONS
@BOTH_CODECS
@pytest.mark.parametrize("impossible", [329.0, -326.36, 181.01, -181.01])
def test_angle_that_no_servo_can_report_is_a_protocol_error(
    edition: str, codec: Any, impossible: float
) -> None:
    # 329 degrees are the word 32900: positive by the document's rule, -326.36 in two's complement.
    word = round(impossible * 100)
    word -= 65536 if word > 32767 else 0
    arm: Any
    with ScriptedPeer([_angles_reply(1, 2, word, 4, 5, 6)]) as peer:
        with editions.load(edition).CLIENT(peer.url, codec=codec) as arm:
            with pytest.raises(ProtocolError, match=r"-181\.\.181 degrees \(at byte 8 of"):
                arm.get_angles()


@BOTH_EDITIONS
@BOTH_CODECS
def test_angles_of_servos_that_report_minus_1_are_accepted(edition: str, codec: Any) -> None:
    reply = _angles_reply(18008, 18008, -18008, 18008, 18008, 18008)
    arm: Any
    with ScriptedPeer([reply]) as peer, editions.load(edition).CLIENT(peer.url, codec=codec) as arm:
        assert arm.get_angles() == (180.08, 180.08, -180.08, 180.08, 180.08, 180.08)


@BOTH_EDITIONS
@BOTH_CODECS
def test_gripper_reply_of_105_is_accepted_and_106_is_not(edition: str, codec: Any) -> None:
    replies = [bytes.fromhex("FEFE036569FA")], [bytes.fromhex("FEFE03656AFA")]
    arm: Any
    with (
        ScriptedPeer(*replies) as peer,
        editions.load(edition).CLIENT(peer.url, codec=codec) as arm,
    ):
        assert arm.get_gripper_value() == 105
        with pytest.raises(ProtocolError, match=r"value is 106; allowed: .*105"):
            arm.get_gripper_value()
        with pytest.raises(UsageError, match=r"value is 105; allowed: .*100"):
            arm.set_gripper_value(105, 50)


@BOTH_EDITIONS
@BOTH_CODECS
def test_columns_reject_impossible_angles(edition: str, codec: Any) -> None:
    good, bad = _angles_reply(18008, 0, 0, 0, 0, 0), _angles_reply(-32636, 0, 0, 0, 0, 0)
    columns = codecs.load(editions.load(edition).TABLE, codec).decode_columns(
        good + bad + good, "reply"
    )
    angles: Any = columns.rows("get_angles")["angles"].tolist()
    assert angles == [[180.08, 0, 0, 0, 0, 0]] * 2


def test_radians_of_an_impossible_angle_are_a_protocol_error() -> None:
    with ScriptedPeer([_angles_reply(-32636, 0, 0, 0, 0, 0)]) as peer, MyCobot280(peer.url) as arm:
        with pytest.raises(ProtocolError, match=r"radians is -326.36; .*-181\.\.181"):
            arm.get_radians()
