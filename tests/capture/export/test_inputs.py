"""Inputs are files, folders, patterns, standard input and URLs, compressed or not."""

from __future__ import annotations

import gzip
import shutil
from pathlib import Path
from typing import get_args

import fsspec
import pytest
import zstandard

from capture.export.exporting import (
    START,
    export,
    polled,
    read_rows,
    recording,
    reply,
    request,
)
from capture.test_foreign import FILES
from cobotwire.capture import Packet, archive
from cobotwire.capture.archive import ThreadEngine
from cobotwire.capture.export import ExportPlan, FormatName, Input, Inputs, write
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import LinkError, UsageError

ANGLES = reply("get_angles", [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
POWERED = reply("is_power_on", 1)


def names(*arguments: Path | str) -> list[str]:
    return [Path(file.url).name for file in Inputs.find([*map(str, arguments)]).files]


@pytest.fixture
def captures(tmp_path: Path) -> Path:
    folder = tmp_path / "captures"
    (folder / "day").mkdir(parents=True)
    for name in ("b.bin", "a.bin", "day/c.bin", ".hidden"):
        (folder / name).write_bytes(ANGLES)
    return folder


def test_folder_means_the_captures_in_and_below_it(captures: Path) -> None:
    assert names(captures) == ["a.bin", "b.bin", "c.bin"]


@pytest.mark.parametrize("engine", [None, ThreadEngine(1)])
def test_folder_with_earlier_exports_is_read_without_them(
    tmp_path: Path, engine: ThreadEngine | None
) -> None:
    recording(tmp_path / "arm.pcapng", polled(2))
    for format in get_args(FormatName):
        export(tmp_path / format, tmp_path / "arm.pcapng", format=format)
    shutil.copy(FILES / "saleae-logic2.csv", tmp_path)
    (tmp_path / "unknown.csv").write_text("time,id,bytes\n1,2,fe fe\n")
    plan = ExportPlan(str(tmp_path / "out"), InstalledEditions())
    inputs = Inputs.find([str(tmp_path)])
    report = archive.export(plan, inputs, engine) if engine else write(plan, inputs)
    left_out = [note for note in report.notes if note.startswith("left out: ")]
    assert (len(left_out), len(inputs.files), report.inputs) == (7, 10, 3)
    assert report.rows == {"get_angles.request": 3, "get_angles.reply": 3}
    assert ["looks like a CSV with 3 columns" in text for text in report.unread] == [True]
    assert any("saleae-logic2.csv: its times have no date" in note for note in report.notes)


def test_pattern_means_the_files_that_match(captures: Path) -> None:
    assert names(captures / "*.bin") == ["a.bin", "b.bin"]
    assert names(captures / "**" / "c*") == ["c.bin"]


def test_file_that_is_named_twice_is_read_once(captures: Path) -> None:
    assert names(captures / "a.bin", captures / "*.bin") == ["a.bin", "b.bin"]


@pytest.mark.parametrize("missing", ["none.bin", "n*.bin", "empty", "memory://none", "none://x"])
def test_input_that_does_not_exist_is_an_error_that_names_it(tmp_path: Path, missing: str) -> None:
    (tmp_path / "empty").mkdir()
    name = missing if "://" in missing else str(tmp_path / missing)
    with pytest.raises(UsageError) as caught:
        Inputs.find([name])
    assert str(caught.value).startswith(f"{name}: ")


def test_standard_input_is_not_combined_with_files(captures: Path) -> None:
    with pytest.raises(UsageError, match="cannot be combined"):
        Inputs.find(["-", str(captures)])


@pytest.mark.parametrize(
    ("url", "robot"),
    [
        ("captures/arm1.pcapng.zst", "arm1"),
        ("s3://bucket/robot=left/day=2026-11-23/part.pcapng", "left"),
        ("arm2.bin.gz", "arm2"),
        *((f"left{ending}", "left") for ending in (".pcap", ".txt", ".csv.gz")),
        ("-", "stdin"),
    ],
)
def test_robot_is_named_by_its_folder_or_its_file(url: str, robot: str) -> None:
    assert Input(url).robot == robot


def compressed(data: bytes, ending: str) -> bytes:
    """Compress data in two parts, as appending programs do."""
    half = len(data) // 2
    press = gzip.compress if ending == ".gz" else zstandard.compress
    return press(data[:half]) + press(data[half:])


@pytest.mark.parametrize("ending", [".gz", ".zst"])
@pytest.mark.parametrize("kind", ["bin", "pcapng"])
def test_compressed_input_has_the_rows_of_the_input(tmp_path: Path, ending: str, kind: str) -> None:
    plain = tmp_path / f"arm.{kind}"
    if kind == "bin":
        plain.write_bytes(ANGLES * 1000)
    else:
        recording(plain, polled(100))
    pressed = tmp_path / f"arm.{kind}{ending}"
    pressed.write_bytes(compressed(plain.read_bytes(), ending))
    export(tmp_path / "plain", plain)
    report = export(tmp_path / "pressed", pressed)
    assert read_rows(tmp_path / "pressed") == read_rows(tmp_path / "plain") != {}
    assert report.truncated == []


@pytest.mark.parametrize("ending", [".gz", ".zst"])
def test_rows_before_the_cut_of_a_compressed_input_are_exported(
    tmp_path: Path, ending: str
) -> None:
    path = tmp_path / f"arm.bin{ending}"
    path.write_bytes(compressed(ANGLES * 1000, ending)[:-5])
    report = export(tmp_path / "out", path)
    assert report.truncated == [f"{path}: has compressed data that is cut off"]
    assert report.rows["get_angles.reply"] >= 500
    assert not report.clean


@pytest.mark.parametrize("ending", [".gz", ".zst"])
def test_input_that_is_not_compressed_as_its_name_says_is_an_error(
    tmp_path: Path, ending: str
) -> None:
    path = tmp_path / f"arm.bin{ending}"
    path.write_bytes(ANGLES * 100)
    with pytest.raises(LinkError, match="decompressing failed"):
        export(tmp_path / "out", path)
    assert [*(tmp_path / "out").rglob("*")] == []


def test_url_is_read_with_fsspec() -> None:
    store = fsspec.filesystem("memory")
    store.pipe("/lake/robot=left/one.bin", ANGLES)
    store.pipe("/lake/robot=right/two.bin", POWERED)
    try:
        found = Inputs.find(["memory://lake"])
        assert [file.robot for file in found.files] == ["left", "right"]
        assert found.size == len(ANGLES + POWERED)
        assert len(Inputs.find(["memory://lake/*/t*.bin"]).files) == 1
    finally:
        store.rm("/lake", recursive=True)


def test_rows_of_a_url_equal_those_of_the_file(tmp_path: Path) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(20))
    export(tmp_path / "by path", path)
    export(tmp_path / "by url", path.as_uri())
    assert read_rows(tmp_path / "by url") == read_rows(tmp_path / "by path") != {}


@pytest.mark.parametrize("finish", [True, False])
def test_recording_that_ends_too_early_is_exported_and_reported(
    tmp_path: Path, finish: bool
) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(20), finish=finish)
    if finish:
        path.write_bytes(path.read_bytes()[:-3])
    report = export(tmp_path / "out", path)
    assert report.rows.total() == 40
    (text,) = report.truncated
    assert text.startswith(f"{path}: ")
    assert ("middle of a packet" if finish else "was not finished") in text


def test_rows_before_the_damage_of_a_recording_are_exported(tmp_path: Path) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(20))
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2 // 4 * 4] + b"\xff" * 100)
    report = export(tmp_path / "out", path)
    assert 10 < report.rows.total() < 40
    assert "everything before that is exported" in report.truncated[0]


def test_noise_rejected_frames_and_pauses_are_counted(tmp_path: Path) -> None:
    illegal = bytes.fromhex("FE FE 03 2B 07 FA")
    packets = [
        *polled(3),
        Packet(START + 10**9, "received", b"Guru", "noise", "no-header"),
        Packet(START + 2 * 10**9, "received", illegal),
        Packet(START + 5 * 10**9, "received", POWERED),
    ]
    report = export(tmp_path / "out", recording(tmp_path / "arm.pcapng", packets))
    assert (report.noise, report.rejected) == ({"no-header": 4}, 1)
    assert report.gaps == {"arm": 1}
    assert not report.clean


def test_time_range_includes_its_start_and_excludes_its_end(tmp_path: Path) -> None:
    packets = [Packet(START + second * 10**9, "received", POWERED) for second in range(10)]
    path = recording(tmp_path / "arm.pcapng", packets)
    report = export(tmp_path / "out", path, begin_ns=START + 2 * 10**9, end_ns=START + 5 * 10**9)
    assert (report.rows.total(), report.outside) == (3, 7)


def test_time_range_needs_times(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(request("get_angles"))
    with pytest.raises(UsageError, match="without times, which a time range needs"):
        export(tmp_path / "out", tmp_path / "arm.bin", begin_ns=0)
