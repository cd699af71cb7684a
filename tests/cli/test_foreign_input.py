"""Run subcommands on files of other programs, and on empty files."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from capture.lines import written
from capture.test_foreign import ANGLES, ASKED, FILES
from decoding import run
from in_process import cobotwire


def test_socat_dump_is_decoded_with_times_and_directions() -> None:
    code, out, err = run(str(FILES / "socat-x.txt"))
    assert code == 0
    assert out.splitlines()[1].startswith("  0.000550 <        0  frame           FE FE 0E 20")
    assert "socat-x.txt as a socat dump (--raw: read it as raw bytes); its times have no" in err
    assert run(str(FILES / "socat-x.txt"), "--read-as", "socat") == (0, out, "")


def test_annotations_without_times_are_shown_without_times() -> None:
    code, out, _ = run(str(FILES / "pulseview.txt"))
    assert (code, out[:20]) == (0, " " * 11 + ">        ")
    first = json.loads(run(str(FILES / "pulseview.txt"), "--json")[1].splitlines()[0])
    assert (first["time_ns"], first["after"], first["direction"]) == (None, None, "sent")


def test_dump_without_times_or_directions_is_decoded_as_raw_bytes(tmp_path: Path) -> None:
    text, raw = tmp_path / "dump.py", tmp_path / "raw.bin"
    text.write_text(f"{ANGLES!r}\n{list(ASKED)}\n")
    raw.write_bytes(ANGLES + ASKED)
    assert run(str(text))[:2] == run(str(raw))[:2]


def test_port_chooses_the_direction(tmp_path: Path) -> None:
    path = FILES / "ethernet.pcap"
    code, _, err = run(str(path), "--tcp-port", "9001")
    assert code == 2
    assert err.splitlines()[-1].endswith("choose the arm's, such as --tcp-port 9000")
    assert run(str(path), "--tcp-port", "9000")[1].splitlines()[0].split()[1] == ">"


def times(path: Path, folder: Path) -> list[object]:
    done = cobotwire("export", path, "-o", folder, "--json")
    assert done.returncode == 0, done
    [notice] = json.loads(done.stdout)["notes"]
    assert f"reading {path} as" in notice
    column = pq.read_table(folder / "get_angles.reply.parquet").column("time")
    return [None if each is None else each.value for each in column]


def test_export_has_the_times_of_a_dump_and_invents_none(tmp_path: Path) -> None:
    [first, _, last] = times(FILES / "sll.pcap", tmp_path / "timed")
    assert last - first == 51_911_986  # type: ignore[operator]
    assert times(FILES / "pulseview.txt", tmp_path / "untimed") == [None]


def test_export_reports_a_wrong_line_and_keeps_what_came_before(tmp_path: Path) -> None:
    path = tmp_path / "dump.txt"
    path.write_bytes((FILES / "socat-x.txt").read_bytes() + b"oops\n")
    done = cobotwire("export", path, "-o", tmp_path / "out")
    assert done.returncode == 1
    assert "3 x get_angles.reply" in done.stderr
    assert f"incomplete: {path}: line 13: expected a line of a socat dump" in done.stderr


@pytest.mark.parametrize("size", ["file", "recording"])
@pytest.mark.parametrize(
    "subcommand",
    [
        ["decode"],
        ["decode", "--summary"],
        ["export", "-o", "out"],
        ["export", "--command", "get_angles", "--direction", "reply", "-o", "out.parquet"],
        ["replay"],
        ["replay", "--serve"],
        ["plot", "-o", "out.svg"],
    ],
    ids=" ".join,
)
def test_empty_input_is_one_error(subcommand: Sequence[str], size: str, tmp_path: Path) -> None:
    path = tmp_path / "nothing"
    path.write_bytes(written([]) if size == "recording" else b"")
    words = [str(tmp_path / word) if word.startswith("out") else word for word in subcommand]
    done = cobotwire(*words, path)
    assert (done.returncode, done.stderr) == (2, f"cobotwire: {path} is empty\n")
    assert list(tmp_path.iterdir()) == [path]


def test_empty_standard_input_is_the_same_error() -> None:
    assert run("-", stdin=b"")[0::2] == (2, "cobotwire: standard input is empty\n")


def test_one_of_several_files_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    (tmp_path / "a.bin").write_bytes(b"")
    (tmp_path / "b.bin").write_bytes(ANGLES)
    code, out, err = run(str(tmp_path), "--json")
    assert (code, err) == (2, f"cobotwire: {tmp_path / 'a.bin'} is empty\n")
    assert json.loads(out)["file"].endswith("b.bin")
    done = cobotwire("export", tmp_path, "-o", tmp_path / "out")
    assert done.returncode == 1
    assert f"{tmp_path / 'a.bin'} is empty" in done.stderr
    assert "1 x get_angles.reply" in done.stderr
