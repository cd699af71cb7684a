"""Record traffic with a simulated arm; print and serve it with ``cobotwire replay``."""

from __future__ import annotations

import json
import signal
import time
from functools import partial
from pathlib import Path

import pytest

from capture.export.exporting import polled, recording
from cobotwire import MyCobot, ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.capture import Recording, read
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer
from cobotwire.transport import TappedTransport, open_transport
from command_line import printed, started
from in_process import cobotwire

run = partial(cobotwire, "replay")
ANGLES = (10.0, -20.0, 30.0, 0.0, 5.5, 0.0)


def converse(url: str, tap: Recording | None = None) -> list[object]:
    """Exchange some requests and replies; return the results."""
    transport = open_transport(url, 115200)
    with MyCobot(transport if tap is None else TappedTransport(transport, tap.record)) as arm:
        results: list[object] = [arm.is_power_on()]
        arm.power_on()
        results.append(arm.is_power_on())
        arm.set_digital_output(23, True)
        results.append(arm.get_angles())
        return results


@pytest.fixture
def recorded(server: PtyServer, tmp_path: Path) -> tuple[Path, list[object]]:
    """Record an exchange; return the file and the results."""
    path = tmp_path / "arm.pcapng"
    with Recording(path, codecs.load(TABLE), url=server.url, baudrate=115200) as recording:
        results = converse(server.url, recording)
    return path, results


def test_replay_prints_a_timeline(recorded: tuple[Path, list[object]]) -> None:
    result = run(recorded[0])
    assert result.returncode == 0
    assert result.stderr == ""
    lines = result.stdout.splitlines()
    assert lines[0] == "  0.000000 > FE FE 02 12 FA   is_power_on()"
    assert lines[1].endswith(" < FE FE 03 12 00 FA   -> is_power_on(powered=no)")
    assert any("  power_on()" in line for line in lines)
    assert len(lines) == len(list(read(recorded[0])))


def test_json_output_is_an_object_per_packet(recorded: tuple[Path, list[object]]) -> None:
    result = run(recorded[0], "--json")
    entries = [json.loads(line) for line in result.stdout.splitlines()]
    packets = list(read(recorded[0]))
    assert [bytes.fromhex(entry["data"]) for entry in entries] == [p.data for p in packets]
    assert [entry["time_ns"] for entry in entries] == [p.time_ns for p in packets]
    assert entries[0]["direction"] == "sent"
    assert entries[0]["kind"] == "frame"


def test_served_recording_gives_the_recorded_replies(recorded: tuple[Path, list[object]]) -> None:
    path, results = recorded
    with started("replay", path, "--serve") as process:
        url = printed(process).strip()
        assert converse(url) == results
        # A second client gets the same replies from the beginning.
        assert converse(url) == results
        with MyCobot(url, timeout=0.2) as arm, pytest.raises(ReplyTimeout):
            arm.get_coords()
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=10)
        assert (process.returncode, errors) == (0, "")
        assert "FE FE 02 12 FA   replied with 6 bytes" in output
        assert "FE FE 02 23 FA   this request was not recorded" in output


def test_truncated_recording_is_printed_with_a_warning(recorded: tuple[Path, list[object]]) -> None:
    path, _ = recorded
    whole = path.read_bytes()
    path.write_bytes(whole[:-70])
    result = run(path)
    assert result.returncode == 0
    assert "> FE FE 02 12 FA" in result.stdout
    assert "ends in the middle of a packet; everything before byte" in result.stderr


def test_unfinished_recording_is_printed_with_a_warning(tmp_path: Path) -> None:
    path = tmp_path / "open.pcapng"
    recording = Recording(path, codecs.load(TABLE))
    recording.record("sent", bytes.fromhex("FE FE 02 12 FA"), time.monotonic())
    result = run(path)
    assert "is_power_on()" in result.stdout
    assert "was not finished" in result.stderr
    recording.close()


@pytest.mark.parametrize(
    ("content", "code", "words"),
    [
        (None, 2, "file: no such file"),
        (b"FE FE 02 12 FA", 6, "the file is not a pcapng recording"),
        (b"\n\r\r\n" + bytes(40), 6, "at byte 0"),
    ],
)
def test_file_that_is_not_a_recording_is_rejected(
    tmp_path: Path, content: bytes | None, code: int, words: str
) -> None:
    path = tmp_path / "file"
    if content is not None:
        path.write_bytes(content)
    result = run(path)
    assert result.returncode == code
    assert words in result.stderr
    assert "Traceback" not in result.stderr


def test_timeline_shows_the_chosen_interface(tmp_path: Path) -> None:
    path = recording(
        tmp_path / "two.pcapng", [*polled(1), polled(1)[1]._replace(interface=1)], "", ""
    )
    lines = [run(path, *words).stdout.splitlines() for words in ((), ("--interface", "1"))]
    assert [*map(len, lines)] == [3, 1]
    assert " interface 1 < " in lines[1][0]
    result = run(path, "--interface", "2")
    assert (result.returncode, result.stdout) == (2, "")
    assert "interface is 2; allowed: 0..1" in result.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [(["--interface", "7"], "interface is 7; allowed: 0..0"), (["--speed", "0"], "speed is 0.0")],
)
def test_wrong_options_are_rejected(
    recorded: tuple[Path, list[object]], words: list[str], message: str
) -> None:
    result = run(recorded[0], "--serve", *words)
    assert result.returncode == 2
    assert message in result.stderr
