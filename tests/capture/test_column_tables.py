"""Read the rows of ordinary, large, hostile and unusual captures as arrays and tables."""

from __future__ import annotations

import tracemalloc
from itertools import accumulate
from pathlib import Path

import numpy as np
import polars
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from capture.lines import FRAMES, written
from cobotwire import codec as codecs
from cobotwire.capture import Packet
from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.columns import read_batches, read_columns
from cobotwire.capture.damage import MOST_INTERFACES
from cobotwire.editions import load
from cobotwire.inspect.captured import recorded_codecs
from cobotwire.protocol.errors import CaptureError, UsageError

TABLE = load("mycobot").TABLE
NATIVE = codecs.load(TABLE, "native")
REQUEST, REPLY = FRAMES[:2]
START = 1_700_000_000_000_000_000

both_codecs = pytest.mark.parametrize("name", ["native", "reference"])


def poll(count: int, interface: int = 0) -> list[Packet]:
    """Return the packets of an arm that is polled 100 times a second."""
    packets = []
    for time in range(START, START + count * 10**7, 10**7):
        packets.append(Packet(time, "sent", REQUEST, interface=interface))
        packets.append(Packet(time + 4_000_000, "received", REPLY, interface=interface))
    return packets


@both_codecs
def test_rows_have_times_directions_and_fields(name: codecs.CodecName) -> None:
    found = read_columns(written(poll(3)), codecs.load(TABLE, name))
    rows = found.rows("get_angles")
    assert rows.time.tolist() == [START + 4_000_000 + n * 10**7 for n in range(3)]
    assert rows.offset.tolist() == [0, 17, 34]
    arrays = rows.to_numpy()
    assert list(arrays) == ["time", "direction", "interface", "offset", "angles"]
    assert arrays["time"].dtype == np.dtype("datetime64[ns]")
    assert arrays["direction"].tolist() == ["received"] * 3
    assert arrays["angles"].shape == (3, 6)
    table = pa.table(rows)
    assert table.column_names == list(arrays)
    assert table["time"].cast(pa.int64()).to_pylist() == rows.time.tolist()
    assert table["direction"].to_pylist() == ["received"] * 3
    assert table["interface"].to_pylist() == [0] * 3
    frame = polars.DataFrame(rows)
    assert frame["time"].dtype.time_unit == "ns"  # type: ignore[attr-defined]
    requests = found.rows("get_angles", "request", captured="sent")
    assert requests.time.tolist() == [START + n * 10**7 for n in range(3)]


@both_codecs
def test_rows_of_several_interfaces_are_joined_or_chosen(name: codecs.CodecName) -> None:
    data = written([*poll(2), *poll(3, interface=1)], "/dev/a", "/dev/b")
    found = read_columns(data, codecs.load(TABLE, name))
    rows = found.rows("get_angles")
    assert rows.interface.tolist() == [0, 0, 1, 1, 1]
    assert [part.number for part in rows.parts] == [2, 3]
    assert rows["angles"].shape == (5, 6)
    one = found.rows("get_angles", interface=1)
    assert one.time.tolist() == rows.time.tolist()[2:]
    table = found.to_arrow("get_angles", wide=True)
    assert table["interface"].to_pylist() == [0, 1, 0, 1, 1]
    assert table.num_rows == 5
    assert found.to_arrow("get_angles", "request", interface=1).num_rows == 3
    with pytest.raises(UsageError, match=r"interface is 2; allowed: 0\.\.1"):
        found.rows("get_angles", interface=2)


# Rows of several streams, whose times alternate.
MIXED = [
    Packet(START + 1, "sent", REQUEST),
    Packet(START + 2, "received", REPLY),
    Packet(START + 4, "received", REPLY + FRAMES[2], interface=1),
    Packet(START + 3, "unknown", b"\0" + REPLY),
    Packet(START + 5, "received", REPLY),
]


def test_table_has_the_rows_of_all_streams_in_the_order_of_their_times() -> None:
    columns = read_columns(written(MIXED, "/dev/a", "/dev/b"), NATIVE, "reply")
    table = columns.to_arrow("get_angles", wide=True)
    joints = [f"j{joint}" for joint in range(1, 7)]
    assert table.column_names == ["time", "direction", "interface", "offset", *joints]
    assert table["time"].type == pa.timestamp("ns", "UTC")
    assert table["time"].cast(pa.int64()).to_pylist() == [START + n for n in (2, 3, 4, 5)]
    assert table["direction"].to_pylist() == ["received", "unknown", "received", "received"]
    assert table["interface"].to_pylist() == [0, 0, 1, 0]
    assert table["offset"].to_pylist() == [0, 1, 0, 17]
    assert table["j2"].to_pylist() == [-0.01] * 4
    assert table.schema.field("j2").metadata == {b"unit": b"degree"}
    assert columns.to_arrow("get_angles", captured="unknown").num_rows == 1


@pytest.mark.parametrize("wide", [False, True], ids=["nested", "wide"])
def test_batches_with_and_without_rows_fill_one_parquet_file(wide: bool, tmp_path: Path) -> None:
    data = written(MIXED, "/dev/a", "/dev/b")
    whole = read_columns(data, NATIVE, "reply").to_arrow("get_angles", wide=wide)
    path = tmp_path / "angles.parquet"
    counts = []
    with pq.ParquetWriter(path, whole.schema) as writer:
        for batch in read_batches(data, NATIVE, "reply", piece=40):
            if batch.streams:
                table = batch.to_arrow("get_angles", wide=wide)
                writer.write_table(table)
                counts.append(table.num_rows)
    assert 0 in counts
    assert pq.read_table(path).sort_by("time").to_pylist() == whole.to_pylist()


def test_capture_without_packets_has_no_rows_to_choose() -> None:
    found = read_columns(written([]), NATIVE)
    assert list(found) == []
    with pytest.raises(UsageError, match="capture has no packets"):
        found.rows("get_angles")


def test_each_interface_is_decoded_with_the_edition_that_it_names() -> None:
    file = [blocks.section("x")]
    for index, edition in enumerate(("mycobot280", "mercury_a1")):
        file.append(blocks.interface(f"/dev/{index}", f"edition {edition}", 0))
    for index, interface in enumerate(read_columns(b"".join(file), NATIVE).interfaces):
        data = recorded_codecs()(interface).encode("get_angles", "request", ())
        file.append(blocks.packet(index, START, data, blocks.OUTBOUND, ""))
    found = read_columns(b"".join(file), recorded_codecs())
    assert [stream.columns.table.edition for stream in found.streams] == [
        "mycobot280",
        "mercury_a1",
    ]
    assert len(found.rows("get_angles", "request", interface=1)) == 1
    with pytest.raises(UsageError, match="interfaces 0 and 1 have different editions"):
        found.rows("get_angles", "request")


@pytest.mark.parametrize("piece", [1 << 16, 1 << 22])
def test_large_capture_has_the_rows_and_times_of_its_bytes(piece: int) -> None:
    # Packets end anywhere, so frames begin within packets; several blocks of bulk reading.
    rng = np.random.default_rng(5)
    stream = REPLY * 40_000
    sizes = rng.integers(0, 60, 25_000).tolist()
    ends = [min(end, len(stream)) for end in accumulate(sizes)]
    ends[-1] = len(stream)
    starts = [0, *ends[:-1]]
    times = [START + n * 1_000 for n in range(len(ends))]
    data = written(
        Packet(time, "received", stream[start:end], "bytes")
        for time, start, end in zip(times, starts, ends)
    )
    places = np.arange(40_000) * len(REPLY)
    expected = np.array(times)[np.searchsorted(np.array(starts), places, side="right") - 1]
    batches = [batch.rows("get_angles") for batch in read_batches(data, NATIVE, piece=piece)]
    assert np.concatenate([np.asarray(rows.time) for rows in batches]).tolist() == expected.tolist()
    assert np.concatenate([np.asarray(rows.offset) for rows in batches]).tolist() == places.tolist()


def test_frame_has_the_time_of_its_first_byte_if_each_byte_came_by_itself() -> None:
    # A reader that forgets the first byte of an unfinished frame reports the time of a later one.
    # The second frame is certain only at the end, since a longer one seems to begin before it.
    line, step = REPLY + REPLY[:4] + FRAMES[2], 10**6
    data = written(
        Packet(START + at * step, "received", line[at : at + 1]) for at in range(len(line))
    )
    for piece in (1, 40, len(data)):
        found = {
            rows.command.name: (rows.offset.tolist(), rows.time.tolist())
            for batch in read_batches(data, NATIVE, piece=piece)
            for rows in batch
        }
        expected = {"get_angles": 0, "is_power_on": 21}
        assert found == {name: ([at], [START + at * step]) for name, at in expected.items()}


def test_rejected_frame_has_its_time_and_offset() -> None:
    illegal = bytes.fromhex("FE FE 03 12 07 FA")
    data = written([Packet(START, "received", REPLY), Packet(START + 1, "received", illegal)])
    [stream] = read_columns(data, NATIVE).streams
    assert [list(column) for column in stream.rejected] == [[START + 1], [17]]


def test_long_noise_has_the_time_of_its_first_byte() -> None:
    noise = [Packet(START + n, "received", bytes(1000), "bytes") for n in range(1500)]
    data = written([*noise, Packet(START + 9999, "received", REPLY)])
    spans = [
        (time, offset, size)
        for batch in read_batches(data, NATIVE, piece=1 << 17)
        for stream in batch.streams
        for time, offset, size in zip(*stream.noise)
    ]
    assert spans == [(START, 0, 1_500_000)]


def test_reader_keeps_little_memory_while_it_reads(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    path.write_bytes(written(poll(60_000)))
    tracemalloc.start()
    found = sum(len(batch) for batch in read_batches(path, NATIVE, piece=1 << 16))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found == 120_000
    assert peak < 2_000_000


@both_codecs
def test_capture_with_too_many_interfaces_is_rejected(name: codecs.CodecName) -> None:
    interface = blocks.interface("", "", 0)
    data = blocks.section("x") + interface * (MOST_INTERFACES + 1)
    with pytest.raises(CaptureError, match="more than 1024 interfaces") as caught:
        read_columns(data, codecs.load(TABLE, name))
    assert caught.value.offset == len(data) - len(interface)
