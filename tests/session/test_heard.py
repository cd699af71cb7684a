"""What a timeout tells, however much was heard."""

from __future__ import annotations

from cobotwire.codec.interface import Frame, Noise
from cobotwire.session import Heard, Unasked
from cobotwire.session.heard import LINES, SHOWN


def test_adjacent_noise_is_one_line_and_little_memory() -> None:
    heard = Heard()
    for index in range(10_000):
        heard.add(Noise(index * 4096, b"x" * 4096, "no-header"))
    assert len(heard._noise) <= SHOWN
    [line] = heard.lines()
    assert line == f"noise (no-header) {'78 ' * 23}78 ... 40960000 bytes"


def test_the_last_lines_are_kept() -> None:
    heard = Heard()
    for index in range(1000):
        heard.add(Unasked(Frame(index, bytes([index % 256]), 1)))
        heard.add(Noise(index, b"\xff", "no-header"))
    assert heard.lines()[-1] == "noise (no-header) FF"
    assert heard.lines()[-2] == "frame E7"
    assert len(heard.lines()) == LINES
