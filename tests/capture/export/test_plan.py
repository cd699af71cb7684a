"""Plans cross processes, and the reports of several exports add up."""

from __future__ import annotations

import pickle
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from capture.export.exporting import export, polled, recording, reply
from cobotwire.capture.export import ExportPlan, Inputs, Report, write
from cobotwire.capture.export.times import time_ns
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import UsageError


def test_parts_of_an_export_in_one_folder_add_up_to_the_whole(tmp_path: Path) -> None:
    (tmp_path / "raw.bin").write_bytes(b"noise" + reply("get_angles", [0.0] * 6) * 5)
    inputs = [recording(tmp_path / "arm.pcapng", polled(3)), tmp_path / "raw.bin"]
    whole = export(tmp_path / "whole", *inputs, direction="reply")
    reports = []
    for number, path in enumerate(inputs):
        plan = ExportPlan(
            str(tmp_path / "parts"), InstalledEditions(), direction="reply", part=f"{number:05}"
        )
        again = pickle.loads(pickle.dumps(plan))
        reports.append(pickle.loads(pickle.dumps(write(again, Inputs.find([str(path)])))))
    merged = Report.merge(reports)
    names = sorted(path.name for path in (tmp_path / "parts").iterdir())
    assert names == ["get_angles.reply-00000.parquet", "get_angles.reply-00001.parquet"]
    assert [file.rows for file in merged.files] == [3, 5]
    merged.files, whole.files = [], []
    assert merged == whole
    assert pq.read_table(tmp_path / "parts").num_rows == 8


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1970-01-01", 0),
        ("1970-01-01T00:00:01", 10**9),
        ("1970-01-01T01:00:00.000001+01:00", 1000),
        ("1969-12-31T23:59:59Z", -(10**9)),
        ("2026-11-23T02:13:20Z", 1_795_400_000 * 10**9),
    ],
)
def test_time_without_an_offset_is_utc(text: str, expected: int) -> None:
    assert time_ns(text, "--from") == expected


def test_command_of_another_edition_is_allowed_because_a_recording_may_have_that_edition() -> None:
    ExportPlan("out", InstalledEditions(), commands=("set_pro_gripper",))
    with pytest.raises(UsageError, match="did you mean set_pro_gripper"):
        ExportPlan("out", InstalledEditions("mycobot320"), commands=("set_pro_griper",))
