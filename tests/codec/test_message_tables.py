"""The columns of a message's table are the same for every capture, in every edition."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from typing import Any

import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import arrow_values
import random_tables
from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec.interface import Codec, Columns
from cobotwire.codec.table_columns import LEADING
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction, Field, Number, Table, Variant
from strategies import DIRECTIONS
from vectors import sampled

EDITIONS = sampled()


def legal(field: Field, number: Number) -> int:
    """Return a raw value that a number may hold."""
    return (field.choices or number.choices or (number.clamp(1),))[-1]


def legal_rows(variant: Variant) -> list[tuple[int, ...]]:
    """Return raw values that a variant may hold, a tuple for each field."""
    rows = [tuple([legal(field, n) for n in field.cases[0].numbers]) for field in variant.fields]
    for index, field in enumerate(variant.fields):
        if field.selector >= 0:
            case = field.cases[-1]
            rows[field.selector] = case.when[:1]
            rows[index] = tuple([legal(field, number) for number in case.numbers])
    return rows


def every_message(table: Table, direction: Direction) -> bytes:
    """Return a stream with a frame of each variant of each message."""
    addresses = cycle(table.frame.addresses or [None])
    return b"".join(
        table.frame.enclose(
            command.id, variant.pack(legal_rows(variant)), next(addresses), direction
        )
        for command in table.commands
        for variant in command.variants(direction)
    )


def messages(codec: Codec, stream: bytes, direction: Direction) -> dict[str, list[Any]]:
    """Return the messages of a stream by command, decoded one by one."""
    framer = codec.framer(direction)
    found: dict[str, list[Any]] = {}
    for event in framer.feed(stream) + framer.flush():
        try:
            message = getattr(event, "message", None)
        except ProtocolError:
            continue
        if message is not None:
            found.setdefault(message.command.name, []).append(message)
    return found


def tables(
    codec: Codec, stream: bytes, direction: Direction, raw: bool = False
) -> Iterator[tuple[str, bool, Columns, Any]]:
    """Yield the table of each message that has variants, and whether it is wide."""
    columns = codec.decode_columns(stream, direction, raw=raw)
    for command in codec.table.commands:
        for wide in (False, True) if command.variants(direction) else ():
            yield command.name, wide, columns, columns.to_arrow(command.name, direction, wide=wide)


def filled(row: dict[str, Any], names: list[str]) -> dict[str, Any]:
    """Return a row of a table; null where its variant lacks a column."""
    return {name: row.get(name) for name in names}


def lacks_pandas_type(field: Any) -> bool:
    """Return whether a column holds bytes, lists, or flags that may be missing."""
    if pa.types.is_boolean(field.type):
        return bool(field.nullable)
    return bool(pa.types.is_binary(field.type) or pa.types.is_list(field.type))


def comparable(value: Any) -> Any:
    """Return a value with a text for NaN, which differs from itself."""
    if isinstance(value, dict):
        return {name: comparable(each) for name, each in value.items()}
    if isinstance(value, list):
        return [comparable(each) for each in value]
    return "NaN" if value != value else value


@pytest.mark.parametrize("edition", EDITIONS)
def test_tables_of_every_edition_hold_the_decoded_messages_and_empty_tables_have_the_same_columns(
    edition: str,
) -> None:
    table = editions.load(edition).TABLE
    native, reference = codecs.load(table, "native"), codecs.load(table, "reference")
    columns: dict[Any, Any] = {}
    nothing = {raw: reference.decode_columns(b"", raw=raw) for raw in (False, True)}
    for direction in DIRECTIONS:
        stream = every_message(table, direction)
        expected = messages(native, stream, direction)
        assert sum(map(len, expected.values())) == sum(
            len(command.variants(direction)) for command in table.commands
        )
        for name, wide, _, found in tables(native, stream, direction):
            row = arrow_values.wide_row if wide else arrow_values.row
            fields = found.drop_columns("offset")
            rows = [
                filled(row(each) | arrow_values.device(table, each), fields.column_names)
                for each in expected.get(name, [])
            ]
            assert fields.to_pylist() == rows, name
            empty = nothing[False].to_arrow(name, direction, wide=wide)
            assert found.schema.equals(empty.schema, check_metadata=True), name
            if wide:
                columns |= {field.with_name("any"): found[field.name] for field in found.schema}
        for name, wide, _, found in tables(native, stream, direction, raw=True):
            empty = nothing[True].to_arrow(name, direction, wide=wide)
            assert found.schema.equals(empty.schema, check_metadata=True), name
    for field, column in columns.items():
        assert lacks_pandas_type(field) or str(column.to_pandas().dtype) != "object", field


@pytest.mark.parametrize("edition", EDITIONS)
def test_empty_rows_of_every_variant_have_the_same_columns(edition: str) -> None:
    table = editions.load(edition).TABLE
    codec = codecs.load(table, "reference")
    empty = codec.decode_columns(b"")
    for direction in DIRECTIONS:
        for rows in codec.decode_columns(every_message(table, direction), direction):
            without = empty.rows(rows.command.name, direction, rows.variant_index)
            assert pa.table(rows).schema.equals(pa.table(without).schema, check_metadata=True)
            for name, array in without.to_numpy().items():
                filled_array = rows.to_numpy()[name]
                assert (array.shape[1:], array.dtype) == (
                    filled_array.shape[1:],
                    filled_array.dtype,
                )


@settings(max_examples=60)
@given(data=st.data())
def test_tables_of_random_editions_hold_the_decoded_messages(data: st.DataObject) -> None:
    table = data.draw(random_tables.tables())
    # Twice, so that a message has several rows.
    stream = data.draw(random_tables.streams(table)) * 2
    direction = data.draw(st.sampled_from(DIRECTIONS))
    codec = codecs.load(table, data.draw(st.sampled_from(["native", "reference"])))
    expected = messages(codec, stream, direction)
    columns = codec.decode_columns(stream, direction)
    empty = codec.decode_columns(b"")
    for command in table.commands:
        if not command.variants(direction):
            continue
        for wide, row in ((False, arrow_values.row), (True, arrow_values.wide_row)):
            try:
                found = columns.to_arrow(command.name, direction, wide=wide)
            except UsageError:
                with pytest.raises(UsageError, match="differ in the type"):
                    empty.to_arrow(command.name, direction, wide=wide)
                continue
            without = empty.to_arrow(command.name, direction, wide=wide)
            assert found.schema.equals(without.schema, check_metadata=True)
            assert len({*found.column_names}) == len(found.column_names)
            names = found.column_names[1:]
            rows = [
                filled(row(each) | arrow_values.device(table, each), names)
                for each in expected.get(command.name, [])
            ]
            assert comparable(found.select(names).to_pylist()) == comparable(rows)
            found.validate(full=True)


def test_leading_columns_replace_the_offset(codec: Codec) -> None:
    stream = every_message(codec.table, "reply")
    columns = codec.decode_columns(stream, "reply")
    rows = columns.rows("get_angles")
    table = rows.to_arrow(wide=True, leading={"time": pa.array([7]), "offset": rows.offset})
    assert table.column_names[:3] == ["time", "offset", "j1"]
    with pytest.raises(UsageError, match="has a column j1: rename the leading one"):
        rows.to_arrow(wide=True, leading={"j1": rows.offset})
    with pytest.raises(UsageError, match="time has 2 rows, and the table 1"):
        rows.to_arrow(leading={"time": pa.array([7, 8])})


def test_column_of_a_field_named_like_a_leading_column_is_prefixed_with_its_direction() -> None:
    codec = codecs.load(editions.load("pro450").TABLE)
    rows = codec.decode_columns(b"").rows("get_pro_gripper_offset")
    assert "offset" in rows.names
    assert [*rows.to_numpy()][-1] == rows.to_arrow().column_names[-1] == "reply_offset"
    jog = codec.decode_columns(b"").to_arrow("jog_angle", "request")
    assert jog.column_names == ["offset", "joint", "request_direction", "speed"]
    assert {"offset", "time", "direction"} <= {*LEADING}
