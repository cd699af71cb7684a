"""Exported files equal the typed messages, whichever library reads them."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import duckdb
import pandas as pd
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from capture.export.exporting import (
    START,
    as_typed,
    export,
    polled,
    read_rows,
    recording,
    reply,
    typed_rows,
)
from cobotwire import codec as codecs
from cobotwire.capture import Packet, read
from cobotwire.capture.export import output, sources
from cobotwire.codec.interface import Listening
from cobotwire.editions import load
from cobotwire.inspect.captured import messages

LISTENING: list[Listening] = ["request", "reply", "both"]
EDITIONS = ["mycobot280", "mycobot320", "mercury_a1", "pro450"]
ANGLES = [
    reply("get_angles", [1.5, -2.25, 0.0, 160.0, -160.0, float(number)]) for number in range(5)
]


@settings(max_examples=25)
@given(st.data())
def test_rows_equal_typed_messages_and_every_byte_is_counted(data: st.DataObject) -> None:
    edition = data.draw(st.sampled_from(EDITIONS))
    listening = data.draw(st.sampled_from(LISTENING))
    stream = data.draw(strategies.received(load(edition).TABLE, listening)).data
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "arm.bin").write_bytes(stream)
        report = export(folder / "out", folder / "arm.bin", edition=edition, direction=listening)
        found = read_rows(folder / "out")
    rows, rejected = typed_rows(stream, listening, edition)
    assert found == rows
    assert report.rows == {label: len(each) for label, each in rows.items()}
    assert report.rejected == rejected
    assert report.bytes == len(stream)
    assert report.frames == rejected + sum(map(len, rows.values()))


@settings(max_examples=25)
@given(st.data())
def test_pieces_and_blocks_do_not_change_the_rows(data: st.DataObject) -> None:
    stream = b"".join(data.draw(st.lists(strategies.real_frames(), min_size=1, max_size=30)))
    with TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        folder = Path(name)
        (folder / "arm.bin").write_bytes(stream)
        whole = export(folder / "whole", folder / "arm.bin")
        patch.setattr(sources, "PIECE", data.draw(st.integers(1, 50)))
        patch.setattr(output, "BLOCK_ROWS", data.draw(st.integers(1, 5)))
        patch.setattr(output, "WAITING_BYTES", data.draw(st.integers(0, 2000)))
        patch.setattr(output, "OPEN_FILES", data.draw(st.integers(20, 40)))
        pieces = export(folder / "pieces", folder / "arm.bin")
        assert read_rows(folder / "pieces") == read_rows(folder / "whole")
    assert (pieces.rows, pieces.noise, pieces.bytes) == (whole.rows, whole.noise, whole.bytes)


def test_completed_file_gets_a_numbered_successor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(output, "OPEN_FILES", 1)
    packets = [Packet(START + day * 86_400 * 10**9, "received", ANGLES[0]) for day in (0, 1, 0, 1)]
    report = export(
        tmp_path / "out", recording(tmp_path / "arm.pcapng", packets), partition=("day",)
    )
    assert sorted(Path(file.path).relative_to(tmp_path / "out").as_posix() for file in report.files)
    table = pq.read_table(tmp_path / "out", partitioning="hive")
    assert table.num_rows == 4


def test_times_and_directions_of_a_recording_equal_its_typed_messages(tmp_path: Path) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(50))
    export(tmp_path / "out", path)
    found = sorted(
        (row["time"].as_py().value, path.stem)
        for path in (tmp_path / "out").iterdir()
        for row in pq.read_table(path).select(["time"]).to_batches()[0].to_struct_array()
    )
    expected = [
        (captured.time_ns, f"get_angles.{'request' if captured.direction == 'sent' else 'reply'}")
        for captured in messages(read(path))
    ]
    assert found == sorted(expected)


@pytest.fixture
def angles(tmp_path: Path) -> Path:
    """Export five replies to a Parquet, a CSV and an Arrow file."""
    (tmp_path / "arm.bin").write_bytes(b"".join(ANGLES))
    for ending in ("parquet", "csv", "arrow"):
        format: Any = ending
        export(
            tmp_path / f"angles.{ending}",
            tmp_path / "arm.bin",
            commands=("get_angles",),
            direction="reply",
            format=format,
            wide=True,
        )
    return tmp_path


WIDE = ["robot", "source", "offset", "time", "j1", "j2", "j3", "j4", "j5", "j6"]


@pytest.mark.parametrize(
    "read_table",
    [
        lambda folder: pq.read_table(folder / "angles.parquet"),
        lambda folder: pl.read_parquet(folder / "angles.parquet").to_arrow(),
        lambda folder: duckdb.read_parquet(f"{folder}/angles.parquet").to_arrow_table(),
        lambda folder: pa.Table.from_pandas(pd.read_parquet(folder / "angles.parquet")),
        lambda folder: pl.read_csv(folder / "angles.csv").to_arrow(),
        lambda folder: duckdb.read_csv(f"{folder}/angles.csv").to_arrow_table(),
        lambda folder: pa.Table.from_pandas(pd.read_csv(folder / "angles.csv")),
        lambda folder: pa.ipc.open_file(folder / "angles.arrow").read_all(),
        lambda folder: pl.read_ipc(folder / "angles.arrow").to_arrow(),
        lambda folder: pa.Table.from_pandas(pd.read_feather(folder / "angles.arrow")),
    ],
    ids=[
        *("parquet pyarrow", "parquet polars", "parquet duckdb", "parquet pandas"),
        *("csv polars", "csv duckdb", "csv pandas"),
        *("arrow pyarrow", "arrow polars", "arrow pandas"),
    ],
)
def test_each_reader_reads_what_was_exported(angles: Path, read_table: Any) -> None:
    table = read_table(angles)
    assert table.column_names == WIDE
    assert table.column("robot").to_pylist() == ["arm"] * 5
    assert table.column("offset").to_pylist() == [17 * number for number in range(5)]
    assert table.column("j2").to_pylist() == [-2.25] * 5
    assert table.column("j6").to_pylist() == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_units_and_names_are_in_the_metadata(angles: Path) -> None:
    schema = pq.read_schema(angles / "angles.parquet")
    assert schema.field("j1").metadata[b"unit"] == b"degree"
    assert schema.metadata[b"command"] == b"get_angles"


def test_file_without_rows_has_the_columns_of_one_with_rows(angles: Path) -> None:
    (angles / "noise.bin").write_bytes(b"noise\0")
    report = export(
        angles / "none.parquet",
        angles / "noise.bin",
        commands=("get_angles",),
        direction="reply",
        wide=True,
    )
    assert report.files[0].rows == 0
    empty, full = (pq.read_schema(angles / name) for name in ("none.parquet", "angles.parquet"))
    assert empty.equals(full, check_metadata=True)


def test_values_that_csv_has_no_type_for_are_text(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(reply("is_power_on", 1))
    export(tmp_path / "out", tmp_path / "arm.bin", format="csv", direction="reply")
    lines = (tmp_path / "out" / "is_power_on.reply.csv").read_text().splitlines()
    assert lines[0] == '"robot","source","offset","time","powered"'
    assert lines[1] == f'"arm","{tmp_path}/arm.bin",0,,true'


def test_rows_of_two_editions_with_other_columns_go_to_two_files(tmp_path: Path) -> None:
    seven = codecs.load(load("myarm300").TABLE).encode("get_angles", "reply", [[0.0] * 7])
    packets = [
        Packet(START, "received", ANGLES[0]),
        Packet(START + 1, "received", seven, interface=1),
    ]
    path = recording(tmp_path / "two.pcapng", packets, "mycobot280", "myarm300")
    report = export(tmp_path / "out", path)
    names = sorted(Path(file.path).name for file in report.files)
    assert names == ["get_angles.reply.myarm300.parquet", "get_angles.reply.parquet"]
    (row,) = pq.read_table(tmp_path / "out" / names[0]).to_pylist()
    assert as_typed(row) == {"offset": 0, "angles": [0.0] * 7}
    assert row["robot"] == "two-1"
