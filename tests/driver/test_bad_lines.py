"""What real lines do to a caller, against a scripted peer on a real pseudo-terminal."""

from __future__ import annotations

import socket
import threading
import time

import pytest

from cobotwire import LinkError, MyCobot, ProtocolError, ReplyTimeout
from cobotwire.editions.mycobot import TABLE, Angles
from cobotwire.sim import SimulatedArm
from scripted_peer import ScriptedPeer

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
READ = Angles(1.4, 0.61, -0.26, -1.93, 1.75, -1.75)
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
SERVO_LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def test_a_silent_arm_is_a_timeout_that_says_what_was_asked() -> None:
    with ScriptedPeer() as peer, MyCobot(peer.url, timeout=0.1) as arm:
        started = time.monotonic()
        with pytest.raises(
            ReplyTimeout, match=r"no answer to get_angles within 0\.1.*nothing"
        ) as caught:
            arm.get_angles()
        assert 0.09 < time.monotonic() - started < 0.4
        assert isinstance(caught.value, TimeoutError)
        assert caught.value.command == "get_angles"
        time.sleep(0.05)
        assert peer.heard == bytes.fromhex("FEFE0220FA"), "asked once, and once only"


def test_the_deadline_is_the_documents_500_ms_unless_told_otherwise() -> None:
    with ScriptedPeer() as peer, MyCobot(peer.url) as arm:
        started = time.monotonic()
        with pytest.raises(ReplyTimeout):
            arm.get_angles()
        assert 0.48 < time.monotonic() - started < 0.9


@pytest.mark.parametrize(
    "script",
    [
        [SERVO_LEAK + ANGLES],
        [POWERED + ANGLES],
        [b"cmd_len error\r\n" + ANGLES],
        [b"\xfe" + ANGLES],
        [b"\xfe\xfe\xfe" + ANGLES],
        [ANGLES[:8], 0.1, ANGLES[8:]],
        [ANGLES + SERVO_LEAK],
        [bytes(277) + ANGLES],
        [bytes([byte]) for byte in ANGLES],
    ],
    ids=[
        "a servo leak in front",
        "another command's reply in front",
        "firmware text in front",
        "one FE in front",
        "three FE in front",
        "a pause of 100 ms inside",
        "a servo leak behind",
        "277 NULs in front",
        "byte by byte",
    ],
)
def test_the_reply_is_found_whatever_stands_around_it(script: list[bytes | float]) -> None:
    with ScriptedPeer(script) as peer, MyCobot(peer.url) as arm:
        assert arm.get_angles() == READ


def test_a_frame_hidden_behind_a_false_header_comes_at_the_deadline() -> None:
    script = [bytes.fromhex("FE FE 0E 20") + POWERED]
    with ScriptedPeer(script) as peer, MyCobot(peer.url, timeout=0.15) as arm:
        assert arm.is_power_on() is True


def test_a_timeout_tells_what_was_heard_meanwhile() -> None:
    with ScriptedPeer([SERVO_LEAK + POWERED]) as peer, MyCobot(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout) as caught:
            arm.get_angles()
    assert caught.value.heard == (
        "noise (no-header) FF FF 01 04 02 38 02 BE",
        "frame FE FE 03 12 01 FA",
    )


def test_a_late_reply_does_not_answer_the_next_question() -> None:
    stale = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
    with ScriptedPeer([0.15, stale], [ANGLES]) as peer, MyCobot(peer.url, timeout=0.1) as arm:
        with pytest.raises(ReplyTimeout):
            arm.get_angles()
        time.sleep(0.15)
        assert arm.get_angles() == READ


def test_a_reply_for_another_joint_is_not_taken() -> None:
    other = bytes.fromhex("FE FE 05 4A 03 00 00 FA")
    right = bytes.fromhex("FE FE 05 4A 02 F9 F2 FA")
    with ScriptedPeer([other + right]) as peer, MyCobot(peer.url) as arm:
        assert arm.get_joint_min_angle(2) == -155.0


def test_a_reply_without_its_echo_is_taken_from_older_firmware() -> None:
    with ScriptedPeer([bytes.fromhex("FE FE 03 50 01 FA")]) as peer, MyCobot(peer.url) as arm:
        assert arm.is_servo_enable(1) is True


def test_a_value_that_the_edition_rules_out_is_an_error() -> None:
    with ScriptedPeer([bytes.fromhex("FE FE 03 12 07 FA")]) as peer, MyCobot(peer.url) as arm:
        with pytest.raises(
            ProtocolError, match="powered holds 7, allowed: True or False"
        ) as caught:
            arm.is_power_on()
        assert caught.value.reason == "bad-value"


def test_a_text_reply_that_can_be_read_in_two_ways_is_an_error() -> None:
    text = b"ssid: a password: b password: c"
    with ScriptedPeer([text]) as peer, MyCobot(peer.url) as arm:
        with pytest.raises(ProtocolError, match="2 times"):
            arm.get_ssid_pwd()


def test_no_such_port() -> None:
    with pytest.raises(
        LinkError, match="/dev/nosuchport: cannot be opened: No such file"
    ) as caught:
        MyCobot("/dev/nosuchport")
    assert isinstance(caught.value, OSError)


def test_a_closed_port() -> None:
    with ScriptedPeer() as peer:
        arm = MyCobot(peer.url)
        arm.close()
        arm.close()
        with pytest.raises(LinkError, match="closed"):
            arm.power_on()
        with pytest.raises(LinkError, match="closed"):
            arm.get_angles()
        assert peer.heard == b""


def test_a_port_that_goes_away_while_waiting() -> None:
    with ScriptedPeer([ANGLES[:5], 0.1, None]) as peer, MyCobot(peer.url, timeout=5) as arm:
        started = time.monotonic()
        with pytest.raises(LinkError):
            arm.get_angles()
        assert time.monotonic() - started < 2


def test_a_port_that_another_program_has_open() -> None:
    with ScriptedPeer() as peer, MyCobot(peer.url):
        with pytest.raises(LinkError, match="another program has it open"):
            MyCobot(peer.url)


def test_over_tcp_with_every_byte_a_packet_of_its_own() -> None:
    simulated = SimulatedArm(TABLE)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]

        def serve() -> None:
            connection, _ = listening.accept()
            with connection:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                while data := connection.recv(3):
                    for byte in simulated.receive(data):
                        connection.sendall(bytes([byte]))

        thread = threading.Thread(target=serve)
        thread.start()
        with MyCobot(f"socket://127.0.0.1:{port}") as arm:
            arm.power_on()
            assert arm.is_power_on() is True
            assert arm.get_angles() == Angles(0, 0, 0, 0, 0, 0)
        thread.join()


def test_loop_echoes_our_own_request_and_it_is_no_answer() -> None:
    with MyCobot("loop://", timeout=0.1) as arm, pytest.raises(ReplyTimeout) as caught:
        arm.get_angles()
    assert "FE FE 02 20 FA" in caught.value.heard[0]
