"""Check what calls return on bad lines: both clients, scripted peers on a real pty and real TCP.

``tests/field_notes`` has the lines of the field notes; this module has all others.
"""

from __future__ import annotations

from typing import Any

import pytest

from both_ways import Opener
from cobotwire import MyCobot280, ProtocolError, ReplyTimeout
from cobotwire.editions.mycobot import Angles
from scripted_peer import ScriptedPeer

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
READ = Angles(1.4, 0.61, -0.26, -1.93, 1.75, -1.75)
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
SERVO_LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")
PANIC = (
    b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n"
    + b"Core 1 register dump:\r\nPC      : 0x400d1a2b  PS      : 0x00060830\r\n" * 30
    + b"Rebooting...\r\n"
    + bytes(277)
)
REQUEST = bytes.fromhex("FE FE 02 20 FA")

FOUND = {
    "one FE before the reply": [b"\xfe" + ANGLES],
    "three FE before the reply": [b"\xfe\xfe\xfe" + ANGLES],
    "a pause longer than an attempt inside the reply": [ANGLES[:8], 0.25, ANGLES[8:]],
    "a servo leak after the reply": [ANGLES + SERVO_LEAK],
    "a damaged reply before the reply": [ANGLES[:6] + ANGLES[7:] + ANGLES],
    "a panic inside the reply, then the reply again": [ANGLES[:9] + PANIC + ANGLES],
}


@pytest.mark.parametrize("script", FOUND.values(), ids=FOUND)
def test_reply_is_found_among_other_bytes(
    open_arm: Opener, peer_on: Any, script: list[Any]
) -> None:
    with peer_on(script) as peer, open_arm(peer.url) as arm:
        assert arm.get_angles() == READ


@pytest.mark.parametrize(
    "script",
    [ANGLES[:9] + PANIC, ANGLES[:9] + ANGLES[10:], POWERED, REQUEST, SERVO_LEAK, bytes(277)],
    ids=[
        "a panic inside",
        "a dropped byte",
        "another command's reply",
        "an echo",
        "a leak",
        "NULs",
    ],
)
def test_missing_reply_raises_a_timeout_and_the_next_call_succeeds(
    open_arm: Opener, peer_on: Any, script: bytes
) -> None:
    with peer_on([script], [POWERED]) as peer, open_arm(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout) as caught:
            arm.get_angles()
        assert caught.value.received, "it lists what was received instead"
        assert isinstance(caught.value, TimeoutError)
        assert arm.is_power_on() is True


def test_frame_hidden_after_a_false_header_is_found_at_the_deadline(
    open_arm: Opener, peer_on: Any
) -> None:
    script = [bytes.fromhex("FE FE 0E 20") + POWERED]
    with peer_on(script) as peer, open_arm(peer.url, timeout=0.15) as arm:
        assert arm.is_power_on() is True


def test_timeout_lists_what_was_received_instead(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([SERVO_LEAK + POWERED]) as peer, open_arm(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout) as caught:
            arm.get_angles()
    assert caught.value.received == (
        "noise (no-header) FF FF 01 04 02 38 02 BE: servo bus leak: "
        "read 2 bytes at register 0x38 (present position) of servo 1",
        "frame FE FE 03 12 01 FA",
    )


def test_timeout_reports_that_the_controller_rebooted(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([PANIC]) as peer, open_arm(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout, match="the controller rebooted: panic LoadProhibited"):
            arm.get_angles()


def test_reply_for_another_joint_is_not_used(open_arm: Opener, peer_on: Any) -> None:
    other = bytes.fromhex("FE FE 05 4A 03 00 00 FA")
    right = bytes.fromhex("FE FE 05 4A 02 F9 F2 FA")
    with peer_on([other + right]) as peer, open_arm(peer.url) as arm:
        assert arm.get_joint_min_angle(2) == -155.0


def test_reply_of_older_firmware_without_repeated_argument_is_used(open_arm: Opener) -> None:
    with ScriptedPeer([bytes.fromhex("FE FE 03 50 01 FA")]) as peer, open_arm(peer.url) as arm:
        assert arm.is_servo_enable(1) is True


def test_value_that_the_edition_does_not_allow_is_an_error(open_arm: Opener) -> None:
    with ScriptedPeer([bytes.fromhex("FE FE 03 12 07 FA")]) as peer, open_arm(peer.url) as arm:
        with pytest.raises(ProtocolError, match="powered is 7; allowed: True or False") as caught:
            arm.is_power_on()
        assert caught.value.reason == "bad-value"


def test_angle_that_no_servo_can_report_is_an_error_in_the_unit_of_the_caller() -> None:
    reply = bytes.fromhex("FE FE 0E 20 80 84") + bytes(10) + b"\xfa"
    with ScriptedPeer([reply]) as peer, MyCobot280(peer.url) as arm:
        with pytest.raises(ProtocolError, match=r"radians is -326.36; .*-181\.\.181"):
            arm.get_radians()


def test_ambiguous_text_reply_is_an_error(open_arm: Opener) -> None:
    text = b"ssid: a password: b password: c"
    with ScriptedPeer([text]) as peer, open_arm(peer.url) as arm:
        with pytest.raises(ProtocolError, match="2 times"):
            arm.get_ssid_pwd()


def test_echo_of_a_loop_url_is_not_a_reply(open_arm: Opener) -> None:
    with open_arm("loop://", timeout=0.1) as arm, pytest.raises(ReplyTimeout) as caught:
        arm.get_angles()
    assert "FE FE 02 20 FA" in caught.value.received[0]
