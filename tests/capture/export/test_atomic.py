"""However an export ends, no file with a final name is incomplete, and the next run succeeds."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

import pyarrow.parquet as pq
import pytest

from capture.export.exporting import export, reply
from cobotwire.capture.export import atomic_file
from cobotwire.capture.export.atomic_file import AtomicFile
from cobotwire.protocol.errors import OutputError, UsageError
from command_line import PROGRAM

ANGLES = reply("get_angles", [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
POWERED = reply("is_power_on", 1)


def files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.rglob("*") if path.is_file())


def finals(folder: Path) -> list[str]:
    return [name for name in files(folder) if not name.startswith(".")]


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_interrupted_export_leaves_no_final_file_and_can_be_repeated(
    tmp_path: Path, number: signal.Signals
) -> None:
    out = tmp_path / "out"
    # An export of standard input waits for more bytes, so the signal interrupts it.
    process = subprocess.Popen([*PROGRAM, "export", "-", "-o", str(out)], stdin=subprocess.PIPE)
    assert process.stdin is not None
    process.stdin.write((ANGLES * 99 + POWERED) * 11_000)
    process.stdin.flush()
    deadline = time.monotonic() + 60
    while not any(name.endswith("tmp") for name in files(out)):
        assert time.monotonic() < deadline, "the export did not begin"
        time.sleep(0.05)
    process.send_signal(number)
    code = process.wait(60)
    with suppress(BrokenPipeError):
        process.stdin.close()
    assert finals(out) == []
    if number == signal.SIGINT:
        assert (code, files(out)) == (130, [])
    (tmp_path / "arm.bin").write_bytes(ANGLES * 10 + POWERED)
    export(out, tmp_path / "arm.bin")
    assert files(out) == ["get_angles.reply.parquet", "is_power_on.reply.parquet"]
    assert pq.read_table(out / "get_angles.reply.parquet").num_rows == 10


def limited(*words: str | Path, limit: int) -> subprocess.CompletedProcess[str]:
    """Run the command line with files of at most ``limit`` bytes, as if the disk were full."""
    script = (
        # Python would write a part of each compiled file, and use it in later processes.
        "import resource, sys\nsys.dont_write_bytecode = True\n"
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))\n"
        "from cobotwire.cli import main\n"
        "main()"
    )
    command = [sys.executable, "-c", script, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.parametrize("ending", ["parquet", "csv", "arrow"])
def test_full_disk_is_an_error_that_names_the_file(tmp_path: Path, ending: str) -> None:
    varied = (
        reply("get_angles", [float(number % 160), 2.0, 3.0, 4.0, 5.0, 6.0])
        for number in range(2000)
    )
    (tmp_path / "arm.bin").write_bytes(b"".join(varied))
    out = tmp_path / f"angles.{ending}"
    options = ("--command", "get_angles", "--direction", "reply")
    done = limited("export", tmp_path / "arm.bin", "-o", out, *options, limit=2000)
    assert done.returncode == 8, done.stderr
    assert done.stderr.startswith(f"cobotwire: {out}: writing failed: ")
    assert "Traceback" not in done.stderr
    assert files(tmp_path) == ["arm.bin"]


def test_existing_file_is_replaced_only_on_request(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(POWERED)
    out = tmp_path / "out"
    export(out, tmp_path / "arm.bin")
    (tmp_path / "arm.bin").write_bytes(POWERED * 2)
    with pytest.raises(UsageError, match="exists already; --overwrite replaces it"):
        export(out, tmp_path / "arm.bin")
    assert pq.read_table(out / "is_power_on.reply.parquet").num_rows == 1
    export(out, tmp_path / "arm.bin", overwrite=True)
    assert pq.read_table(out / "is_power_on.reply.parquet").num_rows == 2
    assert files(out) == ["is_power_on.reply.parquet"]


def test_failing_export_with_overwrite_leaves_the_old_file(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(POWERED)
    out = tmp_path / "out"
    export(out, tmp_path / "arm.bin")
    (tmp_path / "bad.bin.gz").write_bytes(b"not gzip")
    with pytest.raises(OSError, match="decompressing failed"):
        export(out, tmp_path / "arm.bin", tmp_path / "bad.bin.gz", overwrite=True)
    assert pq.read_table(out / "is_power_on.reply.parquet").num_rows == 1
    assert files(out) == ["is_power_on.reply.parquet"]


def test_two_exports_of_one_file_do_not_disturb_each_other(tmp_path: Path) -> None:
    first, second = (AtomicFile(tmp_path / "a.parquet", overwrite=True) for _ in range(2))
    first.file.write(b"first")
    second.file.write(b"second")
    for each in (first, second):
        each.finish()
        each.publish()
    assert (tmp_path / "a.parquet").read_bytes() == b"second"
    assert files(tmp_path) == ["a.parquet"]


def test_files_of_killed_exports_are_removed_and_others_are_kept(tmp_path: Path) -> None:
    for name in ("a.parquet.12345678", "b.parquet.12345678"):
        (tmp_path / f".{name}.cobotwire-tmp").write_bytes(b"half")
    running = AtomicFile(tmp_path / "a.parquet", overwrite=False)
    other = AtomicFile(tmp_path / "a.parquet", overwrite=False)
    left = files(tmp_path)
    assert len(left) == 3
    assert ".b.parquet.12345678.cobotwire-tmp" in left
    running.discard()
    other.discard()
    assert files(tmp_path) == [".b.parquet.12345678.cobotwire-tmp"]


def test_finished_file_is_kept_until_it_is_published(tmp_path: Path) -> None:
    finished = AtomicFile(tmp_path / "a.parquet", overwrite=True)
    finished.file.write(b"whole")
    finished.finish()
    AtomicFile(tmp_path / "a.parquet", overwrite=True).discard()
    finished.publish()
    assert (tmp_path / "a.parquet").read_bytes() == b"whole"


def test_file_that_appears_during_the_export_is_not_replaced(tmp_path: Path) -> None:
    atomic = AtomicFile(tmp_path / "a.parquet", overwrite=False)
    (tmp_path / "a.parquet").write_bytes(b"other")
    with pytest.raises(UsageError, match="exists already"):
        atomic.publish()
    atomic.discard()
    assert (tmp_path / "a.parquet").read_bytes() == b"other"


def test_folder_that_cannot_be_created_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(OutputError, match="writing failed"):
        AtomicFile(tmp_path / "file" / "a.parquet", overwrite=False)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="the system has no /dev/full")
def test_device_without_space_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "arm.bin").write_bytes(POWERED)

    def open_full(name: Path, mode: str) -> BinaryIO:
        return os.fdopen(os.open("/dev/full", os.O_WRONLY), "wb")

    monkeypatch.setattr(atomic_file, "open", open_full, raising=False)
    with pytest.raises(OutputError, match="No space left on device"):
        export(
            tmp_path / "a.parquet",
            tmp_path / "arm.bin",
            commands=("is_power_on",),
            direction="reply",
        )
    assert files(tmp_path) == ["arm.bin"]
