"""``cobotwire capture``: reports, exit codes and mistakes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from capture.export.exporting import START, polled, recording, reply
from capture.test_foreign import FILES
from cobotwire.capture import Packet, read
from in_process import Ended, cobotwire

SECOND = 10**9


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    """Record two seconds of an arm, with noise and a pause."""
    noise = Packet(START + SECOND // 10, "received", b"Guru", "noise", "no-header")
    late = Packet(START + 3 * SECOND, "received", reply("is_power_on", 1))
    return recording(tmp_path / "arm.pcapng", [*polled(3), noise, late])


def capture(*words: str | Path) -> Ended:
    return cobotwire("capture", *words)


def test_info_fits_a_terminal(arm: Path) -> None:
    done = capture("info", arm)
    lines = [line.replace(str(arm), "arm.pcapng") for line in done.stdout.splitlines()]
    assert done.returncode == 0
    assert max(map(len, lines)) <= 80
    assert "  duration  3.000 s" in lines
    assert "              4 bytes of noise, 6.56 %: no-header" in lines
    assert "  1 gap longer than 1 s, 2.900 s together:" in lines
    assert any("3 x get_angles.reply" in line and "50.000 per s" in line for line in lines)


def test_info_of_several_files_has_a_total_and_the_worst_exit_code(arm: Path) -> None:
    cut = arm.with_name("cut.pcapng")
    cut.write_bytes(arm.read_bytes()[:-3])
    done = capture("info", arm, cut, "--json")
    shown = json.loads(done.stdout)
    assert (done.returncode, len(shown["files"])) == (1, 2)
    assert (shown["total"]["not_whole"], shown["total"]["frames"]) == (1, 14)
    cut.write_bytes(b"text")
    done = capture("info", arm, cut)
    assert done.returncode == 6
    assert "2 files, 1 of them not whole" in done.stdout
    assert "the file is not a pcapng recording" in done.stdout
    assert capture("info", "/nope").returncode == 2


@pytest.mark.parametrize(
    ("name", "head", "start"),
    [
        ("socat-x.txt", "  551 bytes, a socat dump", "  start     2026-11-24"),
        (
            "saleae-logic1.csv",
            "  470 bytes, a table of Saleae",
            "  start     -0.000250 s (no date)",
        ),
        ("pulseview.txt", "  2275 bytes, annotations of", None),
    ],
)
def test_info_of_another_programs_file_states_its_own_size_and_times(
    name: str, head: str, start: str | None
) -> None:
    lines = capture("info", FILES / name).stdout.splitlines()
    assert lines[1].startswith(head)
    starts = [line for line in lines if line.startswith("  start")]
    assert [line.startswith(start or "") for line in starts] == [True] * bool(start)


def test_cut_takes_seconds_times_and_commands(arm: Path) -> None:
    out = arm.with_name("out.pcapng")
    done = capture("cut", arm, "-o", out, "--from", "0.02", "--to", "2027-01-01T00:00+01:00")
    assert (done.returncode, done.stdout) == (0, "")
    lines = [f"wrote {out}: 6 packets", "  2 packets left out: outside of the time range"]
    assert done.stderr.splitlines() == lines
    assert [packet.time_ns for packet in read(out)][:1] == [START + SECOND // 50]
    done = capture("cut", arm, "-o", out, "--commands", "is_power_on", "--overwrite")
    assert "6 packets left out: other commands\n  1 packet left out: noise" in done.stderr
    done = capture("cut", arm, "-o", out, "--from", "9", "--overwrite")
    assert (done.returncode, f"nothing of {arm} was chosen" in done.stderr) == (1, True)
    arm.write_bytes(arm.read_bytes()[:-3])
    done = capture("cut", arm, "-o", out, "--noise", "keep", "--overwrite")
    assert done.returncode == 1
    assert "in the middle of a block" in done.stderr


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ([], "cut needs a choice"),
        (["--from", "soon"], "--from is 'soon'; give a time in ISO 8601"),
        (["--from", "2", "--to", "1"], "ends before it begins"),
        (["--commands", "get_anglez"], "get_angles"),
    ],
)
def test_mistakes_leave_no_file(arm: Path, words: list[str], text: str) -> None:
    done = capture("cut", arm, "-o", arm.with_name("out.pcapng"), *words)
    assert done.returncode == 2
    assert text in done.stderr
    assert [*arm.parent.iterdir()] == [arm]


def test_merge_warns_about_a_port_that_is_recorded_twice(arm: Path) -> None:
    done = capture("merge", arm, arm, "-o", arm.with_name("out.pcapng"))
    assert done.returncode == 0
    assert "8 packets\n" in done.stderr
    assert "overlap on /dev/ttyACM0: the output may hold bytes twice" in done.stderr


def test_repair_reports_what_is_lost(arm: Path) -> None:
    out = arm.with_name("out.pcapng")
    done = capture("repair", arm, "-o", out)
    assert (done.returncode, done.stderr) == (0, f"{arm} is whole: {out} is a copy\n")
    assert out.read_bytes() == arm.read_bytes()
    arm.write_bytes(out.read_bytes()[:-3])
    done = capture("repair", arm, "-o", out, "--overwrite")
    assert done.returncode == 1
    assert "1 interface marked as finished" in done.stderr
    assert "bytes: the file ends in the middle of a block" in done.stderr
    arm.write_bytes(b"")
    assert capture("repair", arm, "-o", out, "--overwrite").returncode == 6
