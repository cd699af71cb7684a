"""pandas, polars, DuckDB and Parquet agree on the types of tables, also of empty ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import duckdb
import pandas as pd
import polars as pl
import pyarrow.parquet as pq
import pytest

from cobotwire.codec.interface import Codec
from strategies import codec_of

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
MODE = bytes.fromhex("FE FE 03 17 01 FA")
WITH_ECHO = bytes.fromhex("FE FE 04 50 05 01 FA")
WITHOUT = bytes.fromhex("FE FE 03 50 01 FA")
STREAM = b"\0" + ANGLES * 3 + MODE + WITHOUT + WITH_ECHO * 2 + b"\0" + WITHOUT + ANGLES
COMMANDS = ["get_angles", "get_fresh_mode", "is_servo_enable", "get_coords"]
EACH_SHAPE = pytest.mark.parametrize("wide", [False, True], ids=["nested", "wide"])


@pytest.fixture(params=["reference", "native"])
def mycobot280(request: pytest.FixtureRequest) -> Codec:
    return codec_of("mycobot280", request.param)


def batches(codec: Codec, command: str, wide: bool) -> Iterator[Any]:
    """Yield the table of a command after each piece of a stream; most tables have no rows."""
    reader = codec.column_reader("reply")
    for start in range(0, len(STREAM), 9):
        yield reader.feed(STREAM[start : start + 9]).to_arrow(command, wide=wide)
    yield reader.flush().to_arrow(command, wide=wide)


def test_libraries_agree_on_the_types_of_a_wide_table(mycobot280: Codec) -> None:
    columns = mycobot280.decode_columns(STREAM, "reply")
    angles = columns.to_arrow("get_angles", wide=True)
    assert str(pl.DataFrame(angles).schema["j1"]) == "Float64"
    assert angles.to_pandas()["j1"].dtype == "float64"
    query: Any = duckdb.sql("select j1, j1 = 1 from angles")
    assert query.types == ["DOUBLE", "BOOLEAN"]
    servos = columns.to_arrow("is_servo_enable", wide=True)
    assert [str(type) for type in pl.DataFrame(servos).dtypes] == ["UInt64", "Int64", "Boolean"]
    assert [str(type) for type in servos.to_pandas().dtypes] == ["uint64", "float64", "bool"]
    assert [str(type) for type in servos.to_pandas(types_mapper=pd.ArrowDtype).dtypes] == [
        "uint64[pyarrow]",
        "int64[pyarrow]",
        "bool[pyarrow]",
    ]
    query = duckdb.sql("from servos")
    assert query.types == ["UBIGINT", "BIGINT", "BOOLEAN"]
    modes = columns.to_arrow("get_fresh_mode", wide=True)
    assert modes["mode"].to_pylist() == ["REFRESH"]
    assert modes.schema.field("mode").metadata == {b"values": b"INTERPOLATION=0, REFRESH=1"}
    assert str(pl.DataFrame(modes).schema["mode"]) == "Categorical"
    assert modes.to_pandas()["mode"].dtype == "category"
    query = duckdb.sql("select mode from modes where mode = 'REFRESH'")
    assert query.fetchall() == [("REFRESH",)]


@EACH_SHAPE
@pytest.mark.parametrize("command", COMMANDS)
def test_parquet_file_takes_batches_with_and_without_rows(
    mycobot280: Codec, command: str, wide: bool, tmp_path: Path
) -> None:
    whole = mycobot280.decode_columns(STREAM, "reply").to_arrow(command, wide=wide)
    path = tmp_path / "rows.parquet"
    with pq.ParquetWriter(path, whole.schema) as writer:
        for batch in batches(mycobot280, command, wide):
            writer.write_table(batch)
    read = pq.read_table(path)
    # Parquet has its own name for the elements of a list, which counts as metadata.
    assert read.schema.equals(whole.schema, check_metadata=wide)
    assert read.schema.field(1).metadata == whole.schema.field(1).metadata
    assert read.to_pylist() == whole.to_pylist()
    query: Any = duckdb.sql(f"select count(*) from '{path}'")
    assert query.fetchall() == [(whole.num_rows,)]


@EACH_SHAPE
@pytest.mark.parametrize("command", COMMANDS)
def test_rows_beyond_the_offsets_of_an_array_go_into_further_arrays(
    mycobot280: Codec, command: str, wide: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    columns = mycobot280.decode_columns(STREAM, "reply")
    whole = columns.to_arrow(command, wide=wide)
    monkeypatch.setattr("cobotwire.codec.arrow.LARGEST", 48)  # two rows of angles
    pieces = columns.to_arrow(command, wide=wide)
    assert pieces.equals(whole, check_metadata=True)
    if command == "get_angles":
        assert pieces["offset"].num_chunks == 2
