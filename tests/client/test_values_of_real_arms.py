"""Clients send what other clients send, accept what real arms report, and reject the impossible."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import ProtocolError, UsageError, editions
from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.simulator import MemoryTransport, SimulatedArm
from memory_peer import MemoryPeer
from recording_transport import RecordingTransport

BOTH_EDITIONS = pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
BOTH_CODECS = pytest.mark.parametrize("codec", ["reference", "native"])


def _angles_reply(*hundredths: int) -> bytes:
    words = b"".join(value.to_bytes(2, "big", signed=True) for value in hundredths)
    return bytes.fromhex("FEFE0E20") + words + b"\xfa"


def _client(edition: str, transport: Any, codec: Any = "native") -> Any:
    return editions.load(edition).CLIENT(transport, codec=codec)


@BOTH_EDITIONS
@BOTH_CODECS
def test_send_coords_writes_mode_2_and_rejects_mode_3(edition: str, codec: Any) -> None:
    transport = RecordingTransport()
    arm = _client(edition, transport, codec)
    arm.send_coords([150.3, -68.7, 101.8, 10.18, 0, -90], 10, 2)
    with pytest.raises(UsageError, match=r"mode is 3; .*UNEXPLAINED \(2\)"):
        arm.send_coords([150.3, -68.7, 101.8, 10.18, 0, -90], 10, 3)
    assert transport.written == bytes.fromhex("FEFE1025 05DFFD5103FA03FA0000DCD8 0A02FA")


@BOTH_EDITIONS
def test_simulated_arm_moves_to_a_target_of_mode_2(edition: str) -> None:
    simulated = SimulatedArm(editions.load(edition).TABLE, powered=True)
    arm = _client(edition, MemoryTransport(simulated))
    arm.send_coords([150, -60, 250, 180, 0, -90], 80, 2)
    assert arm.is_moving()


@BOTH_EDITIONS
@BOTH_CODECS
@pytest.mark.parametrize(
    ("hundredths", "allowed"),
    [
        (18008, True),  # a servo that reports -1
        (-18008, True),
        (-32636, False),  # by the document's rule 329 degrees, in two's complement -326.36
        (18101, False),
        (-18101, False),
    ],
)
def test_angle_that_no_servo_can_report_is_a_protocol_error(
    edition: str, codec: Any, hundredths: int, allowed: bool
) -> None:
    reply, good = _angles_reply(1, 2, hundredths, 4, 5, 6), _angles_reply(1, 2, 3, 4, 5, 6)
    arm = _client(edition, MemoryTransport(MemoryPeer(reply)), codec)
    if allowed:
        assert arm.get_angles()[2] == hundredths / 100
    else:
        with pytest.raises(ProtocolError, match=r"-181\.\.181 degrees \(at byte 8 of"):
            arm.get_angles()
    used = codecs.load(editions.load(edition).TABLE, codec)
    rows = used.decode_columns(good + reply + good, "reply").rows("get_angles")
    assert len(rows) == 2 + allowed


@BOTH_EDITIONS
@BOTH_CODECS
def test_gripper_reply_of_105_is_accepted_and_106_is_not(edition: str, codec: Any) -> None:
    peer = MemoryPeer(bytes.fromhex("FEFE036569FA"), bytes.fromhex("FEFE03656AFA"))
    arm = _client(edition, MemoryTransport(peer), codec)
    assert arm.get_gripper_value() == 105
    with pytest.raises(ProtocolError, match=r"value is 106; allowed: .*105"):
        arm.get_gripper_value()
    with pytest.raises(UsageError, match=r"value is 105; allowed: .*100"):
        arm.set_gripper_value(105, 50)


def test_radians_of_an_impossible_angle_are_a_protocol_error() -> None:
    arm = MyCobot280(MemoryTransport(MemoryPeer(_angles_reply(-32636, 0, 0, 0, 0, 0))))
    with pytest.raises(ProtocolError, match=r"radians is -326.36; .*-181\.\.181"):
        arm.get_radians()
