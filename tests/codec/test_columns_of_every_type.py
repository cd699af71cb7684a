"""Columns hold bytes, texts and lists; Arrow and NumPy read them with their type and shape."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import arrow_values
import random_values
import vectors
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import CobotwireError
from cobotwire.protocol.table import Direction
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import render_python
from cobotwire_codegen.wire import build_frame

FAMILIES = vectors.ROOT / "tests" / "codegen" / "families"


@pytest.fixture(scope="module")
def edition() -> Edition:
    return build_edition(FAMILIES / "sensor.yaml", FAMILIES)


@pytest.fixture(scope="module")
def table(edition: Edition, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    folder = tmp_path_factory.mktemp("columns")
    write(Target(folder / "columns_sensor", render_python(edition)))
    sys.path.insert(0, str(folder))
    importlib.invalidate_caches()
    yield importlib.import_module("columns_sensor").TABLE
    sys.path.remove(str(folder))


@pytest.fixture(scope="module", params=["reference", "native"])
def sensor(table: Any, request: pytest.FixtureRequest) -> Codec:
    return codecs.load(table, request.param)


@st.composite
def frames(draw: st.DrawFn, edition: Edition) -> bytes:
    """Draw a frame of the sensor with any values and sizes."""
    command = draw(st.sampled_from(edition.commands))
    ways: list[Direction] = ["request", "reply"] if command.replies else ["request"]
    direction = draw(st.sampled_from(ways))
    variant = command.variants(direction)[0]
    values = {f.name: draw(random_values.of_field(f, f.type)) for f in variant if not f.counts}
    counted = random_values.counted(variant, values)
    return build_frame(edition.frame, command, direction, counted)


@settings(max_examples=40)
@given(data=st.data())
def test_arrow_holds_the_decoded_values_in_the_order_of_the_stream(
    sensor: Codec, edition: Edition, data: st.DataObject
) -> None:
    some = data.draw(st.lists(frames(edition), max_size=8))
    columns = sensor.decode_columns(b"".join(some), "reply")
    expected: dict[str, list[Any]] = {}
    for frame in some:
        try:
            message = sensor.decode("reply", frame)
        except CobotwireError:
            continue
        expected.setdefault(message.command.name, []).append(arrow_values.row(message))
    for name, rows in expected.items():
        table = columns.to_arrow(name)
        assert table.drop_columns("offset").to_pylist() == rows
        table.validate(full=True)


def test_types_are_those_of_the_fields_and_stay_without_rows(sensor: Codec) -> None:
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
    stream = b"".join(vector.frame or b"" for vector in edition.vectors)
    columns = sensor.decode_columns(stream, "reply")
    names = pd.DataFrame.from_arrow(columns.to_arrow("get_name"))
    assert names["label"].dtype == "str"
    typed = columns.to_arrow("get_name").to_pandas(types_mapper=pd.ArrowDtype)
    assert [str(dtype) for dtype in typed.dtypes][1:] == [
        "string[pyarrow]",
        "binary[pyarrow]",
        "string[pyarrow]",
    ]
    assert pl.DataFrame(columns.to_arrow("get_satellites"))["words"].to_list() == [["GPS", "é"]]


def test_field_that_a_variant_lacks_is_null(codec: Codec) -> None:
    with_echo, without = "FE FE 04 50 05 01 FA", "FE FE 03 50 01 FA"
    columns = codec.decode_columns(bytes.fromhex(without + with_echo + without), "reply")
    table = columns.to_arrow("is_servo_enable")
    assert table["joint"].to_pylist() == [None, 5, None]
    assert table["enabled"].to_pylist() == [True, True, True]
    assert table["offset"].to_pylist() == [0, 6, 13]
    assert table.schema == codec.decode_columns(b"").to_arrow("is_servo_enable").schema
