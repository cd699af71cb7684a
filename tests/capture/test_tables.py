"""Tables of a capture: one message of all streams, in the order of the times."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from capture.lines import FRAMES, written
from cobotwire.capture import Packet
from cobotwire.capture.columns import read_batches, read_columns
from cobotwire.inspect.captured import recorded_codecs
from cobotwire.protocol.errors import UsageError

codecs = recorded_codecs("mycobot")
REQUEST, ANGLES, POWERED, _ = FRAMES
SECOND = 10**9
PACKETS = [
    Packet(1 * SECOND, "sent", REQUEST),
    Packet(2 * SECOND, "received", ANGLES),
    Packet(4 * SECOND, "received", ANGLES + POWERED, interface=1),
    Packet(3 * SECOND, "unknown", b"\0" + ANGLES),
    Packet(5 * SECOND, "received", ANGLES),
]
DATA = written(PACKETS, "/dev/a", "/dev/b")


def test_table_has_the_rows_of_all_streams_in_the_order_of_their_times() -> None:
    table = read_columns(DATA, codecs, "reply").to_arrow("get_angles", wide=True)
    joints = [f"j{joint}" for joint in range(1, 7)]
    assert table.column_names == ["time", "direction", "interface", "offset", *joints]
    assert table["time"].type == pa.timestamp("ns", "UTC")
    assert table["time"].cast(pa.int64()).to_pylist() == [n * SECOND for n in (2, 3, 4, 5)]
    assert table["direction"].to_pylist() == ["received", "unknown", "received", "received"]
    assert table["interface"].to_pylist() == [0, 0, 1, 0]
    assert table["offset"].to_pylist() == [0, 1, 0, 17]
    assert table["j2"].to_pylist() == [-0.01] * 4
    assert table.schema.field("j2").metadata == {b"unit": b"degree"}


def test_table_is_restricted_to_an_interface_or_direction() -> None:
    columns = read_columns(DATA, codecs, "reply")
    assert columns.to_arrow("get_angles", interface=1).num_rows == 1
    assert columns.to_arrow("get_angles", captured="unknown").num_rows == 1
    with pytest.raises(UsageError, match="interface is 2"):
        columns.to_arrow("get_angles", interface=2)


def test_requests_have_the_time_and_direction_of_their_packets() -> None:
    table = read_columns(DATA, codecs).to_arrow("get_angles", "request", wide=True)
    assert table["direction"].to_pylist() == ["sent"]
    assert table["time"].cast(pa.int64()).to_pylist() == [SECOND]


@pytest.mark.parametrize("wide", [False, True], ids=["nested", "wide"])
def test_batches_with_and_without_rows_fill_one_parquet_file(wide: bool, tmp_path: Path) -> None:
    whole = read_columns(DATA, codecs, "reply").to_arrow("get_angles", wide=wide)
    path = tmp_path / "angles.parquet"
    counts = []
    with pq.ParquetWriter(path, whole.schema) as writer:
        for batch in read_batches(DATA, codecs, "reply", piece=40):
            if batch.streams:
                table = batch.to_arrow("get_angles", wide=wide)
                writer.write_table(table)
                counts.append(table.num_rows)
    assert 0 in counts
    assert pq.read_table(path).sort_by("time").to_pylist() == whole.to_pylist()
