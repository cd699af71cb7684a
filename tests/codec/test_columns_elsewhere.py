"""NumPy and tools that accept Arrow use columns without copying their memory."""

from __future__ import annotations

import sys
import threading

import numpy as np
import pyarrow as pa
import pytest

from cobotwire.codec.interface import Codec, Rows

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
VALUES = [1.0, 2.0, 3.0, 4.0, 5.0, 6.5]


@pytest.fixture
def rows(codec: Codec) -> Rows:
    return codec.decode_columns(b"\0" + ANGLES * 3, "reply").rows("get_angles")


def test_numpy_shares_the_memory(rows: Rows) -> None:
    arrays = rows.to_numpy()
    assert arrays["angles"].dtype == np.float64
    assert arrays["angles"].shape == (3, 6)
    assert arrays["angles"].tolist() == [VALUES] * 3
    assert arrays["offset"].tolist() == [1, 18, 35]
    assert np.shares_memory(arrays["angles"], np.asarray(rows["angles"]))


def test_arrow_shares_the_memory(rows: Rows) -> None:
    table = pa.table(rows)
    assert table.column_names == ["offset", "angles"]
    assert table["angles"].to_pylist() == [VALUES] * 3
    assert table.schema.field("angles").metadata == {b"unit": b"degree"}
    assert table.schema.metadata[b"command"] == b"get_angles"
    address = table["angles"].chunk(0).values.buffers()[1].address
    assert address == rows.to_numpy()["angles"].__array_interface__["data"][0]


def test_memory_outlives_columns_and_codec(codec: Codec) -> None:
    array = codec.decode_columns(ANGLES * 1000, "reply").rows("get_angles").to_numpy()["angles"]
    others = [codec.decode_columns(ANGLES * 1000, "reply") for _ in range(20)]
    assert array.tolist() == [VALUES] * 1000
    assert len(others) == 20


def test_other_thread_may_write_to_the_buffer_during_the_read() -> None:
    # The result may or may not contain the written bytes; nothing else may change.
    from cobotwire import codec as codecs
    from cobotwire.editions.mycobot import TABLE

    codec = codecs.load(TABLE, "native")
    buffer = bytearray(ANGLES * 100_000)
    stop = threading.Event()

    def scribble() -> None:
        while not stop.is_set():
            buffer[4::17] = bytes([1]) * 100_000
            buffer[4::17] = bytes([2]) * 100_000

    thread = threading.Thread(target=scribble)
    thread.start()
    try:
        for _ in range(5):
            angles = codec.decode_columns(buffer, "reply").rows("get_angles").to_numpy()["angles"]
            assert angles.shape == (100_000, 6)
            assert set(np.unique(angles[:, 0])) <= {1.0, 3.56, 6.12}
    finally:
        stop.set()
        thread.join()


def test_decoding_columns_imports_no_extra() -> None:
    import subprocess

    script = (
        "import sys\nfrom cobotwire import codec\nfrom cobotwire.editions.mycobot import TABLE\n"
        f"codec.load(TABLE).decode_columns({ANGLES!r})\n"
        "print([name for name in ('numpy', 'pyarrow') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"
