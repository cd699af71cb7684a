"""``cobotwire export``: options, report, exit codes, missing packages."""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from capture.archive.captures import noisy_stream
from capture.export.exporting import CODEC, START, polled, recording, reply
from cobotwire.capture import Packet
from cobotwire.capture.export import OutputFile, Report
from cobotwire.cli.shared.export_report import report_lines
from in_process import Ended, cobotwire
from terminal import Terminal

SECOND = 10**9
POWERED = reply("is_power_on", 1)


def exported(*words: str | Path) -> Ended:
    return cobotwire("export", *words)


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    """Record two seconds of an arm, with noise and a pause."""
    packets = [
        *polled(3),
        Packet(START + SECOND // 10, "received", b"Guru", "noise", "no-header"),
        Packet(START + 3 * SECOND, "received", POWERED),
    ]
    return recording(tmp_path / "arm.pcapng", packets)


def test_report_counts_what_was_written_and_what_was_lost(arm: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = exported(arm, "-o", out)
    assert (done.returncode, done.stdout) == (1, "")
    lines = done.stderr.splitlines()
    assert lines[0] == "1 input, 76 bytes: 7 rows in 3 files"
    assert "           3 x get_angles.reply" in lines
    assert "4 bytes of noise: 4 no-header" in lines
    assert "1 pause: 1 arm" in lines
    assert any(line.startswith(f"wrote {out}/is_power_on.reply.parquet: ") for line in lines)


def test_report_of_many_messages_is_short(tmp_path: Path) -> None:
    commands = [each.name for each in CODEC.table.commands if each.variants("request")][:30]
    report = Report(rows=Counter({f"{name}.request": 2 for name in commands}))
    report.files = [OutputFile(f"out/{name}.request.parquet", 2, 100) for name in commands]
    lines = [*report_lines(report)]
    assert lines[0] == "0 inputs, 0 bytes: 60 rows in 30 files"
    assert len([line for line in lines if " x " in line]) == 20
    assert "             and 10 other messages; --json counts each" in lines
    assert lines[-1] == "wrote 10 other files: 1000 bytes; --json lists each"


def test_json_report_is_on_standard_output(arm: Path, tmp_path: Path) -> None:
    done = exported(arm, "-o", tmp_path / "out", "--command", "get_angles", "--json")
    assert (done.returncode, done.stderr) == (1, "")
    report = json.loads(done.stdout)
    assert report["rows"] == {"get_angles.reply": 3, "get_angles.request": 3}
    assert report["noise"] == {"no-header": 4}
    assert report["not_chosen"] == 1
    assert {Path(file["path"]).name: file["rows"] for file in report["files"]} == {
        "get_angles.reply.parquet": 3,
        "get_angles.request.parquet": 3,
    }


def test_clean_input_exits_with_0_and_quiet_prints_nothing(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(POWERED)
    done = exported(tmp_path / "arm.bin", "-o", tmp_path / "out", "--quiet")
    assert done == (0, "", "")


def test_standard_input_is_exported(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(POWERED * 3)
    with (tmp_path / "arm.bin").open("rb") as file:
        kept = os.dup(0)
        os.dup2(file.fileno(), 0)
        try:
            done = exported("-", "-o", tmp_path / "out", "--direction", "reply", "--json")
        finally:
            os.dup2(kept, 0)
            os.close(kept)
    assert json.loads(done.stdout)["rows"] == {"is_power_on.reply": 3}


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--command", "get_angels"], "did you mean get_angles?"),
        (["--from", "yesterday"], "--from is 'yesterday'; give a time in ISO 8601, such as 2026-"),
        (["--from", "2026-11-24", "--to", "2026-11-23"], "the time range is empty"),
        (["--partition", "robots"], "did you mean robot?"),
        (["--as", "mcap", "--wide"], "wide columns are for tables"),
        (["none.bin"], "none.bin: no such file"),
        (["--scheduler", "tcp://127.0.0.1:1"], "a scheduler needs a Dask cluster"),
        (["--workers", "2"], "--workers needs --engine threads or --engine dask"),
        (
            ["--engine", "dask", "--scheduler", "tcp://127.0.0.1:1", "--workers", "2"],
            "the cluster has its own workers",
        ),
        (["--output", "memory://out"], "only an export with --engine can write there"),
    ],
)
def test_wrong_usage_is_explained_before_anything_is_written(
    arm: Path, tmp_path: Path, words: list[str], text: str
) -> None:
    done = exported(arm, "-o", tmp_path / "out", *words)
    assert done.returncode == 2
    assert text in done.stderr
    assert not (tmp_path / "out").exists()


def test_single_file_needs_a_single_message(arm: Path, tmp_path: Path) -> None:
    out = tmp_path / "angles.parquet"
    done = exported(arm, "-o", out, "--command", "get_angles")
    assert done.returncode == 2
    assert "choose one with --command and --direction, or give a folder" in done.stderr
    done = exported(arm, "-o", out, "--command", "get_angles", "--direction", "reply")
    assert (done.returncode, pq.read_table(out).num_rows) == (1, 3)


@pytest.mark.parametrize(
    ("begin", "end", "rows"),
    [
        ("2026-11-23", "2026-11-24", 7),
        ("2026-11-23T02:13:20.030Z", "2026-11-23T03:13:22+01:00", 2),
        ("2026-11-24", None, 0),
    ],
)
def test_time_range_is_iso_8601_in_utc(
    arm: Path, tmp_path: Path, begin: str, end: str | None, rows: int
) -> None:
    assert START == 1_795_400_000 * SECOND, "2026-11-23T02:13:20Z"
    until = () if end is None else ("--to", end)
    done = exported(arm, "-o", tmp_path / "out", "--from", begin, *until, "--json")
    report = json.loads(done.stdout)
    assert sum(report["rows"].values()) == rows
    assert report["outside"] == 7 - rows


def test_export_without_a_chosen_message_says_that_it_wrote_nothing(tmp_path: Path) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(3))
    done = exported(path, "-o", tmp_path / "out", "--from", "2030-01-01")
    assert done.returncode == 1
    assert "no file was written: no message was chosen\n" in done.stderr


def test_times_before_1970_are_not_written_to_mcap(tmp_path: Path) -> None:
    path = tmp_path / "neg.csv"
    path.write_text("Time [s],Value\n" + "".join(f"-1,0x{byte:02X}\n" for byte in POWERED))
    done = exported(path, "-o", tmp_path / "arm.mcap")
    assert done.returncode == 2
    assert "times before 1970, which an MCAP file cannot hold" in done.stderr


def test_threads_write_numbered_files_and_report_the_same_counts(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(noisy_stream(300))
    reports = []
    for name, engine in (("one", ()), ("many", ("--engine", "threads"))):
        done = exported(tmp_path / "arm.bin", "-o", tmp_path / name, "--json", *engine)
        assert (done.returncode, done.stderr) == (1, "")
        reports.append({**json.loads(done.stdout), "files": None})
    assert reports[0] == reports[1]
    part = tmp_path / "many" / "get_angles.reply-00000.parquet"
    assert pq.ParquetFile(part).metadata.num_rows == 300


def test_partitions_are_folders_that_readers_know(arm: Path, tmp_path: Path) -> None:
    out = tmp_path / "lake"
    exported(arm, "-o", out, "--partition", "robot,command,day", "--direction", "reply")
    folder = out / "robot=arm" / "command=is_power_on" / "day=2026-11-23"
    assert [path.name for path in folder.iterdir()] == ["is_power_on.reply.parquet"]
    table: Any = pq.read_table(out / "robot=arm" / "command=get_angles", partitioning="hive")
    assert table.column("day").to_pylist() == ["2026-11-23"] * 3
    assert "robot" not in table.column_names


def test_terminal_shows_progress_and_then_the_report(tmp_path: Path) -> None:
    fifo = tmp_path / "arm.bin"
    os.mkfifo(fifo)
    words = ("export", str(fifo), "-o", str(tmp_path / "out"))
    with Terminal(*words, columns=100, lines=30) as terminal:
        # A pipe that is open keeps the export waiting, so its bar is on the screen.
        with fifo.open("wb") as pipe:
            pipe.write(POWERED * 3)
            pipe.flush()
            terminal.until(lambda: "exporting" in terminal.text())
        assert terminal.finish() == 0
        rows = [row.split() for row in terminal.rows()]
        assert ["3", "x", "is_power_on.reply"] in rows
        assert ["exporting"] not in [row[:1] for row in rows]
