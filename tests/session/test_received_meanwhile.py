"""A timeout lists what was received, within bounds on lines and memory."""

from __future__ import annotations

import tracemalloc

import pytest

from cobotwire.codec.interface import Codec, Frame, Noise
from cobotwire.session import UnexpectedFrame
from cobotwire.session.received import KEPT, LINES, ReceivedMeanwhile

REQUEST = bytes.fromhex("FE FE 03 3B 01 FA")
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")
PANIC = b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n"
REBOOT = b"Rebooting...\r\n" + bytes(277)


def test_adjacent_noise_takes_one_line_and_little_memory(codec: Codec) -> None:
    received = ReceivedMeanwhile()
    tracemalloc.start()
    for index in range(10_000):
        received.add(Noise(index * 4096, b"\x81" * 4096, "no-header"))
    used, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert used < 4 * KEPT
    [line] = received.lines(codec, REQUEST, codec.table.command("get_encoder"))
    assert line == f"noise (no-header) {'81 ' * 23}81 ... 40960000 bytes"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (PANIC + REBOOT, "the controller rebooted: panic LoadProhibited"),
        (LEAK, "servo bus leak: read 2 bytes at register 0x38 (present position) of servo 1"),
        (b"cmd_len error\r\n", "the firmware reported cmd_len error"),
        (REQUEST, "echo of our request get_encoder"),
        (bytes([0x81, 0x05]), ""),
    ],
)
def test_noise_is_listed_with_its_diagnosis(codec: Codec, data: bytes, message: str) -> None:
    received = ReceivedMeanwhile()
    for offset, byte in enumerate(data):
        received.add(Noise(offset, bytes([byte]), "no-header"))
    [line] = received.lines(codec, REQUEST, codec.table.command("get_encoder"))
    assert line.partition(": ")[2] == message


def test_panic_interrupted_by_a_frame_is_diagnosed_in_its_first_line(codec: Codec) -> None:
    [frame] = codec.framer("reply").feed(bytes.fromhex("FE FE 03 12 01 FA"))
    assert isinstance(frame, Frame)
    received = ReceivedMeanwhile()
    received.add(Noise(0, PANIC[:30], "no-header"))
    received.add(UnexpectedFrame(Frame(30, frame.data, frame.command)))
    received.add(Noise(30 + len(frame.data), PANIC[30:] + REBOOT, "no-header"))
    first, second, third = received.lines(codec, REQUEST, codec.table.command("get_encoder"))
    assert first.endswith("LoadProhibited")
    assert second == "frame FE FE 03 12 01 FA"
    assert third.startswith("noise (no-header)")


def test_only_the_last_lines_are_kept(codec: Codec) -> None:
    received = ReceivedMeanwhile()
    for index in range(1000):
        received.add(UnexpectedFrame(Frame(index, bytes([index % 256]), 1)))
        received.add(Noise(index, b"\xff", "no-header"))
    assert (
        received.lines(codec, REQUEST, codec.table.command("get_encoder"))[-1]
        == "noise (no-header) FF"
    )
    assert received.lines(codec, REQUEST, codec.table.command("get_encoder"))[-2] == "frame E7"
    assert len(received.lines(codec, REQUEST, codec.table.command("get_encoder"))) == LINES
