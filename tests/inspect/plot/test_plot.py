"""Collect series from recordings and raw bytes, and draw them."""

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
from cobotwire.editions.mypalletizer260 import TABLE as PALLETIZER
from cobotwire.inspect.plot import Series, series_of_bytes, series_of_packets
from cobotwire.inspect.plot.charts import BARS, bar_width, draw
from cobotwire.inspect.plot.series import Track
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire.simulator.faults import Late, Lost, Scenario, ServoLeak
from cobotwire.transport import TappedTransport
from noisy_lines import Received
from strategies import received

CODEC = codecs.load(TABLE)
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def record(path: Path, scenario: Scenario, samples: int = 40) -> int:
    """Record a motion with ten samples a second; return the number of complete samples."""
    clock = SteppedClock(100.0)
    peer = scenario.wrap(SimulatedArm(TABLE, clock=clock), CODEC, clock=clock)
    complete = 0
    with Recording(str(path), CODEC, url="memory://arm", baudrate=115200) as recording:
        transport = TappedTransport(MemoryTransport(peer, clock), recording.record)
        arm = MyCobot280(transport, retry=RetryPolicy(attempts=1))
        arm.power_on()
        arm.send_angles([90, 0, 0, 0, 0, -45], 20)
        for _ in range(samples):
            try:
                arm.get_angles()
                arm.get_coords()
                complete += 1
            except ReplyTimeout:
                pass
            arm.listen(0.1)
    return complete


def series_of(path: Path) -> Series:
    with read(path) as capture:
        return series_of_packets(list(capture), CODEC)


def test_series_holds_each_reply_at_its_time(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    assert record(path, Scenario(name="well")) == 40
    series = series_of(path)
    joints = series.tracks["joints"]
    assert len(joints.rows) == len(series.tracks["coordinates"].rows) == 40
    assert joints.at == pytest.approx([index * 0.1 for index in range(40)], abs=1e-6)
    assert joints.rows[-1] == (90, 0, 0, 0, 0, -45)
    assert (series.axis, series.noise) == ("seconds", [])
    assert series.end == pytest.approx(3.9)
    assert series.reply_times is not None
    assert (series.reply_times.late, series.reply_times.missing) == ([], [])
    # Two acknowledgements, and two replies per sample.
    assert len(series.frames) == 2 + 80


def test_no_line_crosses_a_gap() -> None:
    times = [0.1 * step for step in range(10)] + [4.0, 4.1]
    track = Track(at=times, rows=[(time,) for time in times])
    at, rows = track.with_gaps()
    [gap] = [index for index, (value,) in enumerate(rows) if value != value]
    assert (at[gap - 1], at[gap + 1], len(at)) == (times[9], 4.0, 13)
    slow = Track(at=[0.0, 5.0, 10.0], rows=[(0.0,)] * 3)
    assert slow.with_gaps() == (slow.at, slow.rows), "every five seconds is the usual interval"


def test_series_holds_late_and_lost_replies_and_noise(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    faults = (
        Late(commands=("get_angles",), nth=(3,), seconds=0.7),
        Lost(commands=("get_coords",), nth=(5,)),
        ServoLeak(commands=("get_angles",), nth=(7,)),
    )
    record(path, Scenario(name="sick", faults=faults))
    series = series_of(path)
    assert series.reply_times is not None
    assert [took for _, took in series.reply_times.late] == pytest.approx([0.7], abs=1e-4)
    assert len(series.reply_times.missing) == 1
    assert len(series.noise) >= 1


@given(received(TABLE, "reply"))
def test_series_of_bytes_places_every_frame_and_span_of_noise(line: Received) -> None:
    data = line.data
    if not data:
        return
    series = series_of_bytes([data[:7], data[7:]], CODEC)
    assert (series.axis, series.end, series.reply_times) == ("bytes", len(data), None)
    assert all(0 <= at < len(data) for at in [*series.frames, *(at for at, _ in series.noise)])
    assert len(series.frames) + sum(size for _, size in series.noise) <= len(data)
    again = series_of_bytes([data], CODEC)
    assert (again.frames, again.tracks) == (series.frames, series.tracks)


@given(st.floats(1e-6, 1e9), st.sampled_from([1.0, 1000.0]))
def test_bars_are_few_and_have_round_widths(end: float, unit: float) -> None:
    width = bar_width(end, unit)
    assert end / width <= BARS + 1
    assert f"{width:.0e}"[0] in "125"


def run(*words: str | Path) -> Result:
    """Run the subcommand in this process, because matplotlib takes a second to import."""
    return CliRunner().invoke(app, ["--edition", "mycobot280", "plot", *map(str, words)])


def test_plot_draws_recordings_and_raw_bytes(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    record(path, Scenario(name="sick", faults=(Lost(every=9), ServoLeak(every=5))))
    svg = tmp_path / "arm.svg"
    result = run(path, "-o", svg)
    assert (result.exit_code, result.output) == (0, f"wrote {svg}\n")
    drawn = svg.read_text()
    for label in (
        "joints, °",
        "end, mm",
        "frames received",
        "reply time, ms",
        "time, s",
        "no reply",
    ):
        assert f"<!-- {label}" in drawn, label
    stream = tmp_path / "arm.bin"
    stream.write_bytes(
        (LEAK + bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")) * 50
    )
    png = tmp_path / "arm.PNG"
    assert run(stream, "-o", png).exit_code == 0
    assert png.read_bytes().startswith(b"\x89PNG")


def test_coordinates_are_drawn_by_the_names_and_units_of_their_edition(tmp_path: Path) -> None:
    codec = codecs.load(PALLETIZER)
    stream = codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0)])
    stream += codec.encode("get_coords", "reply", [(100.0, 20.0, 90.0, 45.0)])
    series, path = series_of_bytes([stream], codec), tmp_path / "arm.svg"
    draw(series, str(path), "four joints")
    drawn = path.read_text()
    for text in ("J4", "end, mm", "end, °", "theta"):
        assert text in drawn, text
    assert "J5" not in drawn


def test_bytes_of_unknown_direction_are_drawn_as_decode_reads_them(tmp_path: Path) -> None:
    request = bytes.fromhex("FE FE 02 20 FA")
    path = tmp_path / "can.log"
    text = f"(1.0) can0 123#{request.hex()}\n(2.0) can0 123#{request.hex()}\n"
    path.write_text(text + f"(3.0) can0 124#{LEAK.hex()}\n")
    with read(path) as capture:
        series = series_of_packets([each for each in capture if not each.interface], CODEC)
    assert (series.frames, series.noise, series.reply_times) == ([0, 1], [], None)
    series = series_of_bytes([request * 2], CODEC)
    assert (series.frames, series.noise) == ([0, 5], [])
    result = run(path, "-o", tmp_path / "can.svg")
    assert "only interface 0: can0 123; --interface chooses another of 0..1" in result.stderr
    drawn = (tmp_path / "can.svg").read_text()
    assert "1970" not in drawn
    assert "frames received" not in drawn


def test_plot_rejects_wrong_file_names_and_interfaces(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    record(path, Scenario(name="well"), samples=1)
    for words, message in (
        ((path, "-o", tmp_path / "arm.gif"), "a file name that ends in .png"),
        ((path, "-o", tmp_path / "no" / "arm.png"), "no such file"),
        ((path, "-o", tmp_path / "arm.png", "--interface", "1"), "0..0"),
        ((tmp_path / "none", "-o", tmp_path / "arm.png"), "none: no such file"),
    ):
        result = run(*words)
        assert result.exit_code == 2
        assert message in result.stderr
        assert "Traceback" not in result.stderr
