"""Arrow and NumPy read columns of bytes, texts and lists with their type and shape.

``test_message_tables.py`` compares their values with messages, for random tables.
"""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from cobotwire.codec.interface import Codec
from targets.expected import codec_of_edition
from targets.specs import edition_of

SENSOR = edition_of("sensor")
FRAMES = {vector.name: vector.frame or b"" for vector in SENSOR.vectors}


@pytest.fixture(scope="module", params=["reference", "native"])
def sensor(request: pytest.FixtureRequest) -> Codec:
    return codec_of_edition(SENSOR, request.param)


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


def test_numpy_views_texts_and_groups_on_the_same_memory(sensor: Codec) -> None:
    columns = sensor.decode_columns(FRAMES["get_name reply"] * 2, "reply")
    [rows] = columns
    arrays = rows.to_numpy()
    assert arrays["label"].view("S8").ravel().tolist() == [b"left", b"left"]
    assert np.shares_memory(arrays["label"], np.asarray(rows["label"]))
    columns = sensor.decode_columns(FRAMES["get_joints reply"], "reply")
    joints = columns.rows("get_joints").to_numpy()["joints"]
    assert joints.tolist() == [[[-1.5, -20, 0.25, 2.5, 31]] * 4]


def test_each_row_has_its_own_text(sensor: Codec) -> None:
    names = [("left", b"1234", "à côté"), ("right", b"5678", "au mur!!!")]
    stream = b"".join(sensor.encode("get_name", "reply", each) for each in names)
    table = sensor.decode_columns(stream, "reply").to_arrow("get_name").drop_columns("offset")
    assert [tuple(row.values()) for row in table.to_pylist()] == names
