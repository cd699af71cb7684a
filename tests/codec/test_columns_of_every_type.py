"""Arrow and NumPy read columns of bytes, texts and lists with their type and shape.

``test_message_tables.py`` compares their values with messages, for random tables.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest

import small_specs
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire_codegen.model import Edition
from targets.specs import edition_of


@pytest.fixture(scope="module")
def edition() -> Edition:
    return edition_of("sensor")


@pytest.fixture(scope="module")
def table(edition: Edition, tmp_path_factory: pytest.TempPathFactory) -> Any:
    return small_specs.package(tmp_path_factory.mktemp("columns"), edition).TABLE


@pytest.fixture(scope="module", params=["reference", "native"])
def sensor(table: Any, request: pytest.FixtureRequest) -> Codec:
    return codecs.load(table, request.param)


def test_column_types_follow_the_fields_even_without_rows(sensor: Codec) -> None:
    right = {
        ("get_name", "label"): pa.utf8(),
        ("get_name", "serial"): pa.binary(),
        ("get_satellites", "satellites"): pa.list_(pa.list_(pa.int64(), 2)),
        ("get_satellites", "words"): pa.list_(pa.utf8()),
        ("get_joints", "joints"): pa.list_(pa.list_(pa.float64(), 5), 4),
        ("get_status", "status"): pa.list_(pa.int64(), 4),
    }
    columns = sensor.decode_columns(b"")
    for (command, field), type in right.items():
        table = columns.to_arrow(command)
        assert (table.num_rows, table.schema.field(field).type) == (0, type)
    arrays = columns.rows("get_joints").to_numpy()
    assert (arrays["joints"].shape, arrays["joints"].dtype) == ((0, 4, 5), np.float64)
    raw = sensor.decode_columns(b"", raw=True).rows("get_joints").to_numpy()
    assert (raw["modes"].shape, raw["modes"].dtype) == ((0, 3), np.uint8)


def test_numpy_views_texts_and_groups_on_the_same_memory(sensor: Codec, edition: Edition) -> None:
    by_name = {vector.name: vector.frame or b"" for vector in edition.vectors}
    columns = sensor.decode_columns(by_name["get_name reply"] * 2, "reply")
    [rows] = columns
    arrays = rows.to_numpy()
    assert arrays["label"].view("S8").ravel().tolist() == [b"left", b"left"]
    assert np.shares_memory(arrays["label"], np.asarray(rows["label"]))
    columns = sensor.decode_columns(by_name["get_joints reply"], "reply")
    joints = columns.rows("get_joints").to_numpy()["joints"]
    assert joints.tolist() == [[[-1.5, -20, 0.25, 2.5, 31]] * 4]


def test_pandas_and_polars_have_texts_bytes_and_lists(sensor: Codec, edition: Edition) -> None:
    stream = b"".join(vector.frame or b"" for vector in edition.vectors) * 2
    columns = sensor.decode_columns(stream, "reply")
    names = pd.DataFrame.from_arrow(columns.to_arrow("get_name"))
    assert names["label"].dtype == "str"
    typed = columns.to_arrow("get_name").to_pandas(types_mapper=pd.ArrowDtype)
    assert [str(dtype) for dtype in typed.dtypes][1:] == [
        "string[pyarrow]",
        "binary[pyarrow]",
        "string[pyarrow]",
    ]
    assert pl.DataFrame(columns.to_arrow("get_satellites"))["words"].to_list() == [["GPS", "é"]] * 2


def test_each_row_has_its_own_text(sensor: Codec) -> None:
    names = [("left", b"1234", "à côté"), ("right", b"5678", "au mur!!!")]
    stream = b"".join(sensor.encode("get_name", "reply", each) for each in names)
    table = sensor.decode_columns(stream, "reply").to_arrow("get_name").drop_columns("offset")
    assert [tuple(row.values()) for row in table.to_pylist()] == names
