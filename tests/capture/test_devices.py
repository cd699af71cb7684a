"""Recordings of several devices on one line: every row and file names the device of a message."""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from mcap.reader import make_reader

from capture.export.exporting import export
from cobotwire import MyBuddy
from cobotwire import codec as codecs
from cobotwire.capture.captured_rows import join
from cobotwire.capture.columns import read_batches, read_columns
from cobotwire.editions.mybuddy import TABLE
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock

LEFT, RIGHT = [10.0, -20.0, 30.0, -40.0, 50.0, -60.0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
DEVICES = ["LEFT", "RIGHT"] * 3

both_codecs = pytest.mark.parametrize("name", ["native", "reference"])


@pytest.fixture(scope="module")
def buddy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Record a myBuddy: its arms have different poses, and each reports its angles three times."""
    path = tmp_path_factory.mktemp("devices") / "reported.pcapng"
    clock = SteppedClock()
    robot = SimulatedArm(TABLE, clock=clock, powered=True)
    with MyBuddy(MemoryTransport(robot, clock)) as client:
        client.left.send_angles(LEFT, 100)
        client.right.send_angles(RIGHT, 100)
        client.left.wait_until_reached(LEFT)
        client.right.wait_until_reached(RIGHT)
    with MyBuddy(MemoryTransport(robot, clock), record=path) as client:
        for _ in range(3):
            assert client.left.get_angles() == pytest.approx(LEFT, abs=0.1)
            assert client.right.get_angles() == pytest.approx(RIGHT, abs=0.1)
        assert client.waist.is_power_on()
    return path


@both_codecs
def test_rows_of_a_recording_have_the_address_of_their_arm(buddy: Path, name: Any) -> None:
    codec = codecs.load(TABLE, name)
    found = read_columns(buddy, codec)
    rows = found.rows("get_angles")
    assert list(rows.address or ()) == [1, 2] * 3
    arrays = rows.to_numpy()
    assert [*arrays] == ["time", "direction", "interface", "offset", "address", "angles"]
    for address, angles in ((1, LEFT), (2, RIGHT)):
        reported = arrays["angles"][arrays["address"] == address]
        assert reported.shape == (3, 6)
        assert np.abs(reported - angles).max() < 0.1
    table = found.to_arrow("get_angles", wide=True)
    assert table.column_names[:5] == ["time", "direction", "interface", "offset", "address"]
    assert table["address"].to_pylist() == DEVICES
    assert pa.table(rows).select(range(5)).equals(table.select(range(5)))
    assert found.rows("is_power_on", "request").to_arrow()["address"].to_pylist() == ["WAIST"]
    assert found.rows("get_coords").to_numpy()["address"].shape == (0,)


@both_codecs
@pytest.mark.parametrize("piece", [50, 333])
def test_batches_keep_the_devices(buddy: Path, name: Any, piece: int) -> None:
    batches = [*read_batches(buddy, codecs.load(TABLE, name), piece=piece)]
    filled = [batch for batch in batches if batch.streams]
    assert len(filled) > 2
    tables = [batch.to_arrow("get_angles") for batch in filled]
    assert pa.concat_tables(tables)["address"].to_pylist() == DEVICES


@both_codecs
def test_rows_of_two_robots_are_joined_with_their_devices(buddy: Path, name: Any) -> None:
    streams = read_columns(buddy, codecs.load(TABLE, name)).streams
    received = next(each for each in streams if each.direction == "received")
    rows = received.captured(received.columns.rows("get_angles"))
    assert list(join([rows, rows]).address or ()) == [1, 2] * 6


def test_duckdb_groups_an_export_by_device(buddy: Path, tmp_path: Path) -> None:
    export(tmp_path / "out", buddy, wide=True)
    path = tmp_path / "out" / "get_angles.reply.parquet"
    query = f"SELECT address, round(avg(j6)) FROM '{path}' GROUP BY address ORDER BY 1"
    assert duckdb.execute(query).fetchall() == [("LEFT", -60.0), ("RIGHT", 6.0)]
    metadata = pq.read_schema(path).field("address").metadata
    assert metadata[b"values"] == b"ALL=0, LEFT=1, RIGHT=2, WAIST=3"


def test_each_device_has_topics_of_its_own(buddy: Path, tmp_path: Path) -> None:
    path = tmp_path / "buddy.mcap"
    export(path, buddy, format="mcap", direction="reply")
    found: dict[str, list[Any]] = defaultdict(list)
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            json_like = channel.message_encoding == "json"
            found[channel.topic].append(json.loads(message.data) if json_like else message.data)
    assert sorted(found) == [
        "/reported/left/get_angles/reply",
        "/reported/left/joint_states",
        "/reported/right/get_angles/reply",
        "/reported/right/joint_states",
        "/reported/waist/is_power_on/reply",
    ]
    for arm, angles in (("left", LEFT), ("right", RIGHT)):
        replies = found[f"/reported/{arm}/get_angles/reply"]
        assert [each["angles"] for each in replies] == [pytest.approx(angles, abs=0.1)] * 3
        assert [[*each] for each in replies] == [["angles"]] * 3
    assert found["/reported/waist/is_power_on/reply"] == [{"powered": True}]
