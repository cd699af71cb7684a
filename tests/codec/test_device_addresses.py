"""Each row of devices that share a line has the address of its device.

``test_agreement.py``, ``test_segments.py`` and ``test_message_tables.py`` compare the addresses of
all rows of such an edition.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Columns
from cobotwire.editions import load, mycobot280
from cobotwire.editions.mybuddy import TABLE
from cobotwire.protocol.errors import UsageError
from strategies import codec_of

LEFT, RIGHT, WAIST = 1, 2, 3
BOTH = pytest.mark.parametrize("codec", ["reference", "native"], indirect=True)


@pytest.fixture
def codec(request: pytest.FixtureRequest) -> Codec:
    return codecs.load(TABLE, request.param)


def angles(address: int, *values: float) -> bytes:
    """Return the frame by which a limb reports its angles."""
    codec = codec_of("mybuddy", "reference")
    return codec.encode("get_angles", "reply", [values], address=address)


STREAM = b"".join(
    [
        angles(LEFT, 10, 0, 0, 0, 0, 0),
        angles(RIGHT, -10, 0, 0, 0, 0, 0),
        b"noise",
        angles(RIGHT, -11, 0, 0, 0, 0, 0),
        angles(LEFT, 11, 0, 0, 0, 0, 0),
    ]
)
ADDRESSES = [LEFT, RIGHT, RIGHT, LEFT]
NAMES = ["LEFT", "RIGHT", "RIGHT", "LEFT"]


def addresses_of(columns: Columns) -> list[int]:
    """Return the addresses of all rows with angles."""
    rows = columns.rows("get_angles")
    assert rows.address is not None
    assert rows.address.format == "B"
    assert len(rows.address) == len(rows)
    return rows.address.tolist()


@BOTH
def test_table_names_the_devices_after_the_offset(codec: Codec) -> None:
    columns = codec.decode_columns(STREAM, "reply")
    for table in (columns.to_arrow("get_angles", wide=True), pa.table(columns.rows("get_angles"))):
        assert table.column_names[:2] == ["offset", "address"]
        assert table["address"].to_pylist() == NAMES
        field = table.schema.field("address")
        assert field.type == pa.dictionary(pa.int8(), pa.utf8())
        assert field.metadata == {b"values": b"ALL=0, LEFT=1, RIGHT=2, WAIST=3"}
        table.validate(full=True)
    rows = columns.rows("get_angles")
    arrays = rows.to_numpy()
    assert [*arrays] == ["offset", "address", "angles"]
    assert arrays["address"].dtype == np.uint8
    assert arrays["angles"][arrays["address"] == LEFT, 0].tolist() == [10, 11]
    when = {"offset": rows.offset, "time": pa.array(range(4))}
    assert rows.to_arrow(leading=when).column_names == ["offset", "address", "time", "angles"]
    assert rows.to_arrow(leading={}).column_names == ["address", "angles"]
    with pytest.raises(UsageError, match="mybuddy has a column address: rename the leading one"):
        rows.to_arrow(leading={"address": rows.offset})


@BOTH
def test_address_without_a_name_is_named_by_its_number(codec: Codec) -> None:
    unnamed = codecs.load(TABLE._replace(addresses=()), codec.name)
    table = unnamed.decode_columns(STREAM, "reply").to_arrow("get_angles")
    assert table["address"].to_pylist() == ["1", "2", "2", "1"]


def test_register_address_is_not_the_address_of_a_device() -> None:
    table = codecs.load(load("mycobot320").TABLE).decode_columns(b"").to_arrow("get_pro_gripper")
    assert table.column_names[:3] == ["offset", "gripper_id", "reply_address"]


def test_memory_of_earlier_addresses_is_reused_unless_a_view_exists() -> None:
    codec = codecs.load(TABLE, "native")
    out = codec.decode_columns(STREAM * 2, "reply")
    view: Any = out.rows("get_angles").address
    with pytest.raises(BufferError, match="still used"):
        codec.decode_columns(STREAM, "reply", out=out)
    assert addresses_of(out) == ADDRESSES * 2, "the error leaves the columns intact"
    view.release()
    again = codec.decode_columns(STREAM, "reply", out=out)
    assert addresses_of(again) == ADDRESSES
    other = codecs.load(mycobot280.TABLE, "native")
    request = other.encode("get_angles", "request", ())
    without = other.decode_columns(request, "both", out=again)
    assert without.rows("get_angles", "request").address is None
    assert addresses_of(codec.decode_columns(STREAM, "reply", out=without)) == ADDRESSES
