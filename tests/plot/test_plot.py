"""``cobotwire plot``: what is read out of recordings and streams, and the pictures."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import ReplyTimeout, RetryPolicy
from cobotwire import codec as codecs
from cobotwire.capture import Recording, read
from cobotwire.cli.app import app
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.plot import Series, of_recording, of_stream
from cobotwire.plot.drawing import BARS, bar_width
from cobotwire.sim import MemoryLink, SimulatedArm, SteppedClock
from cobotwire.sim.faults import Late, Lost, Scenario, ServoLeak
from cobotwire.transport import TappedLink
from line import Received
from strategies import received

CODEC = codecs.load(TABLE)
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def record(path: Path, scenario: Scenario, samples: int = 40) -> int:
    """A motion, asked for ten times a second of stepped time; gives how many were answered."""
    clock = SteppedClock(100.0)
    peer = scenario.wrap(SimulatedArm(TABLE, clock=clock), CODEC, clock=clock)
    answered = 0
    with Recording(str(path), CODEC, url="memory://arm", baudrate=115200) as recording:
        link = TappedLink(MemoryLink(peer, clock), recording.record)
        arm = MyCobot280(link, retry=RetryPolicy(tries=1))
        arm.power_on()
        arm.send_angles([90, 0, 0, 0, 0, -45], 20)
        for _ in range(samples):
            try:
                arm.get_angles()
                arm.get_coords()
                answered += 1
            except ReplyTimeout:
                pass
            arm.listen(0.1)
    return answered


def series_of(path: Path) -> Series:
    with read(path) as capture:
        return of_recording(list(capture), CODEC)


def test_what_was_asked_is_in_the_series_at_its_time(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    assert record(path, Scenario(name="well")) == 40
    series = series_of(path)
    joints = series.tracks["joints"]
    assert len(joints.rows) == len(series.tracks["coordinates"].rows) == 40
    assert joints.at == pytest.approx([index * 0.1 for index in range(40)], abs=1e-6)
    assert joints.rows[-1] == (90, 0, 0, 0, 0, -45)
    assert (series.axis, series.noise) == ("seconds", [])
    assert series.end == pytest.approx(3.9)
    assert series.replies is not None
    assert (series.replies.late, series.replies.missing) == ([], [])
    # Two acknowledgements, and two answers each time.
    assert len(series.frames) == 2 + 80


def test_late_and_lost_replies_and_noise_are_found(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    faults = (
        Late(commands=("get_angles",), nth=(3,), seconds=0.7),
        Lost(commands=("get_coords",), nth=(5,)),
        ServoLeak(commands=("get_angles",), nth=(7,)),
    )
    record(path, Scenario(name="sick", faults=faults))
    series = series_of(path)
    assert series.replies is not None
    assert [took for _, took in series.replies.late] == pytest.approx([0.7], abs=1e-4)
    assert len(series.replies.missing) == 1
    assert len(series.noise) >= 1


@given(received(TABLE, "reply"))
def test_every_byte_of_a_stream_is_a_frame_or_noise_and_has_its_place(line: Received) -> None:
    data = line.data
    if not data:
        return
    series = of_stream([data[:7], data[7:]], CODEC)
    assert (series.axis, series.end, series.replies) == ("bytes", len(data), None)
    assert all(0 <= at < len(data) for at in [*series.frames, *(at for at, _ in series.noise)])
    assert len(series.frames) + sum(size for _, size in series.noise) <= len(data)
    again = of_stream([data], CODEC)
    assert (again.frames, again.tracks) == (series.frames, series.tracks)


@given(st.floats(1e-6, 1e9), st.sampled_from([1.0, 1000.0]))
def test_there_are_neither_many_bars_nor_odd_ones(end: float, unit: float) -> None:
    width = bar_width(end, unit)
    assert end / width <= BARS + 1
    assert f"{width:.0e}"[0] in "125"


def run(*words: str | Path) -> Result:
    """In this process, since matplotlib takes a second to import."""
    return CliRunner().invoke(app, ["--edition", "mycobot280", "plot", *map(str, words)])


def test_pictures_of_each_kind(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    record(path, Scenario(name="sick", faults=(Lost(every=9), ServoLeak(every=5))))
    svg = tmp_path / "arm.svg"
    result = run(path, "-o", svg)
    assert (result.exit_code, result.output) == (0, "")
    drawn = svg.read_text()
    for label in ("joints, °", "end, mm", "frames heard", "reply time, ms", "time, s", "no reply"):
        assert f"<!-- {label}" in drawn, label
    stream = tmp_path / "arm.bin"
    stream.write_bytes(
        (LEAK + bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")) * 50
    )
    png = tmp_path / "arm.PNG"
    assert run(stream, "-o", png).exit_code == 0
    assert png.read_bytes().startswith(b"\x89PNG")


def test_what_cannot_be_drawn_is_told(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    record(path, Scenario(name="well"), samples=1)
    for words, said in (
        ((path, "-o", tmp_path / "arm.gif"), "a file that ends in .png"),
        ((path, "-o", tmp_path / "no" / "arm.png"), "a file that can be written"),
        ((path, "-o", tmp_path / "arm.png", "--line", "1"), "0..0"),
        ((tmp_path / "none", "-o", tmp_path / "arm.png"), "none"),
    ):
        result = run(*words)
        assert result.exit_code == 2
        assert said in result.stderr
        assert "Traceback" not in result.stderr
