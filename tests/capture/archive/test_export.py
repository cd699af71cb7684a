"""An export with many workers writes what an export on one machine writes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from capture.archive.captures import archive_in, counts, noisy_stream, on_one_machine, plan, rows
from cobotwire.capture import archive
from cobotwire.capture.archive import ThreadEngine
from cobotwire.capture.export import Inputs, Report
from cobotwire.protocol.errors import LinkError, UsageError


class Single(NamedTuple):
    """The inputs of an export, and what it wrote on one machine."""

    inputs: Inputs
    folder: Path
    report: Report


@pytest.fixture(scope="module")
def single(tmp_path_factory: pytest.TempPathFactory) -> Single:
    inputs = archive_in(tmp_path_factory.mktemp("captures"))
    folder = tmp_path_factory.mktemp("one") / "out"
    return Single(inputs, folder, on_one_machine(folder, inputs))


@pytest.mark.parametrize(("piece_bytes", "workers"), [(20_011, 1), (4096, 3)])
def test_threads_export_the_same_rows_and_counts(
    single: Single, tmp_path: Path, piece_bytes: int, workers: int
) -> None:
    done: list[int] = []
    report = archive.export(
        plan(tmp_path / "out"),
        single.inputs,
        ThreadEngine(workers),
        piece_bytes=piece_bytes,
        progress=done.append,
    )
    assert counts(report) == counts(single.report)
    assert rows(tmp_path / "out") == rows(single.folder)
    assert sum(done) == single.inputs.size
    # The inputs also hold noise and rejected frames.
    assert single.report.inputs == 5
    assert len(single.report.noise) > 2
    assert single.report.rejected > 50
    # The folder holds no other file.
    written = sorted(str(path) for path in (tmp_path / "out").rglob("*") if path.is_file())
    assert sorted(file.path for file in report.files) == written


def test_folders_by_robot_and_command_hold_the_same_rows(single: Single, tmp_path: Path) -> None:
    options: dict[str, Any] = {"partition": ("robot", "command"), "wide": True}
    on_one_machine(tmp_path / "one", single.inputs, **options)
    archive.export(plan(tmp_path / "many", **options), single.inputs, piece_bytes=19_999)
    folders = {path.parent.relative_to(tmp_path / "one") for path in _files(tmp_path / "one")}
    assert len(folders) > 4
    for folder in folders:
        assert rows(tmp_path / "many" / folder) == rows(tmp_path / "one" / folder)


def _files(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file()]


class TwiceEngine:
    """Runs each task twice, like a cluster that considers a slow worker dead."""

    def run(
        self, function: Callable[[Any], Any], tasks: Sequence[Any]
    ) -> Iterator[tuple[int, Any]]:
        for number, task in reversed(list(enumerate(tasks))):
            function(task)
            yield number, function(task)


def test_task_that_runs_twice_counts_once(single: Single, tmp_path: Path) -> None:
    out = tmp_path / "out"
    report = archive.export(plan(out), single.inputs, TwiceEngine(), piece_bytes=30_000)
    assert counts(report) == counts(single.report)
    assert rows(out) == rows(single.folder)
    assert sorted(str(path) for path in _files(out)) == sorted(file.path for file in report.files)


def test_output_that_holds_files_is_refused_or_replaced(single: Single, tmp_path: Path) -> None:
    out = tmp_path / "out"
    archive.export(plan(out), single.inputs, piece_bytes=4000)
    (out / "notes.txt").write_text("mine")
    before = _files(out)
    with pytest.raises(UsageError, match="already holds get_angles"):
        archive.export(plan(out), single.inputs, piece_bytes=30_000)
    assert _files(out) == before
    archive.export(plan(out, overwrite=True), single.inputs, piece_bytes=30_000)
    assert rows(out) == rows(single.folder)
    assert len(_files(out)) < len(before)
    assert (out / "notes.txt").read_text() == "mine"


def test_error_of_a_task_leaves_no_file(single: Single, tmp_path: Path) -> None:
    damaged = tmp_path / "arm9.bin.gz"
    damaged.write_bytes(b"\x1f\x8b\x08 no gzip")
    inputs = Inputs((*single.inputs.files, *Inputs.find([str(damaged)]).files))
    with pytest.raises(LinkError, match="arm9"):
        archive.export(plan(tmp_path / "out"), inputs, piece_bytes=30_000)
    assert _files(tmp_path / "out") == []


def test_file_that_becomes_shorter_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(500))
    inputs = Inputs.find([str(path)])
    path.write_bytes(path.read_bytes()[:5000])
    with pytest.raises(LinkError, match=r"ends at byte 5000 instead of \d+: did it change"):
        archive.export(plan(tmp_path / "out"), inputs, piece_bytes=1000)


def test_bytes_appended_during_the_export_are_not_exported(tmp_path: Path) -> None:
    path = tmp_path / "arm.bin"
    path.write_bytes(noisy_stream(500))
    inputs = Inputs.find([str(path)])
    one = on_one_machine(tmp_path / "one", inputs)
    with path.open("ab") as file:
        file.write(noisy_stream(10))
    many = archive.export(plan(tmp_path / "many"), inputs, piece_bytes=1000)
    assert counts(many) == counts(one)


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        (
            {"output": "all.parquet", "commands": ("get_angles",)},
            "each piece needs a file: give a fol",
        ),
        ({"begin_ns": 1}, "bytes without times"),
        ({"piece_bytes": 0}, "piece_bytes is 0; allowed: 1 and more"),
        ({"inputs": ["-"]}, "standard input, which several workers cannot read"),
    ],
    ids=["one file", "times", "no piece", "standard input"],
)
def test_arguments_that_an_archive_cannot_have_are_refused(
    single: Single, tmp_path: Path, wrong: dict[str, Any], text: str
) -> None:
    output = tmp_path / wrong.pop("output", "out")
    piece_bytes = wrong.pop("piece_bytes", 30_000)
    inputs = Inputs.find(wrong.pop("inputs")) if "inputs" in wrong else single.inputs
    with pytest.raises(UsageError, match=text):
        archive.export(plan(output, **wrong), inputs, piece_bytes=piece_bytes)
    assert _files(tmp_path) == []
