"""What a timeout tells, however much was heard."""

from __future__ import annotations

import tracemalloc

import pytest

from cobotwire.codec.interface import Codec, Frame, Noise
from cobotwire.session import Heard, Unasked
from cobotwire.session.heard import KEPT, LINES

ASKED = bytes.fromhex("FE FE 03 3B 01 FA")
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")
PANIC = b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n"
REBOOT = b"Rebooting...\r\n" + bytes(277)


def test_adjacent_noise_is_one_line_and_little_memory(codec: Codec) -> None:
    heard = Heard()
    tracemalloc.start()
    for index in range(10_000):
        heard.add(Noise(index * 4096, b"\x81" * 4096, "no-header"))
    used, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert used < 4 * KEPT
    [line] = heard.lines(codec, ASKED)
    assert line == f"noise (no-header) {'81 ' * 23}81 ... 40960000 bytes"


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (PANIC + REBOOT, "the controller rebooted: panic LoadProhibited"),
        (LEAK, "servo bus leak: read 2 bytes at register 0x38 (present position) of servo 1"),
        (b"cmd_len error\r\n", "the firmware said cmd_len error"),
        (ASKED, "echo of our own get_encoder"),
        (bytes([0x81, 0x05]), ""),
    ],
)
def test_noise_is_told_with_what_it_is(codec: Codec, data: bytes, said: str) -> None:
    heard = Heard()
    for offset, byte in enumerate(data):
        heard.add(Noise(offset, bytes([byte]), "no-header"))
    [line] = heard.lines(codec, ASKED)
    assert line.partition(": ")[2] == said


def test_a_panic_around_a_frame_is_told_where_it_begins(codec: Codec) -> None:
    [frame] = codec.framer("reply").feed(bytes.fromhex("FE FE 03 12 01 FA"))
    assert isinstance(frame, Frame)
    heard = Heard()
    heard.add(Noise(0, PANIC[:30], "no-header"))
    heard.add(Unasked(Frame(30, frame.data, frame.command)))
    heard.add(Noise(30 + len(frame.data), PANIC[30:] + REBOOT, "no-header"))
    first, second, third = heard.lines(codec, ASKED)
    assert first.endswith("LoadProhibited")
    assert second == "frame FE FE 03 12 01 FA"
    assert third.startswith("noise (no-header)")


def test_the_last_lines_are_kept(codec: Codec) -> None:
    heard = Heard()
    for index in range(1000):
        heard.add(Unasked(Frame(index, bytes([index % 256]), 1)))
        heard.add(Noise(index, b"\xff", "no-header"))
    assert heard.lines(codec, ASKED)[-1] == "noise (no-header) FF"
    assert heard.lines(codec, ASKED)[-2] == "frame E7"
    assert len(heard.lines(codec, ASKED)) == LINES
