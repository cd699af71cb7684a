"""Compute the rows that an Arrow table must hold from messages that were decoded one by one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cobotwire.codec.events import DecodedMessage
from cobotwire.codec.table_columns import column_name, part_names, table_columns
from cobotwire.protocol.addresses import address_name
from cobotwire.protocol.fields import Field
from cobotwire.protocol.table import Table


def device(table: Table, message: DecodedMessage) -> dict[str, Any]:
    """Return the address column of a message; empty if its frame has no address."""
    if message.address is None:
        return {}
    return {"address": address_name(table, message.address)}


def row(message: DecodedMessage) -> dict[str, Any]:
    """Return the values of a message by column, as a table of the message holds them."""
    fields = message.variant.fields
    return {
        column_name(field.name, message.direction): in_list(field, value)
        for field, value in zip(fields, message.values)
    }


def wide_row(message: DecodedMessage) -> dict[str, Any]:
    """Return the values of a message by column, as a wide table of the message holds them."""
    parts = {
        (field.name, part): value
        for field, values in zip(message.variant.fields, message.values)
        for part, value in _parts(field, values)
    }
    variants = message.command.variants(message.direction)
    columns = table_columns(variants, message.direction, wide=True)
    return {
        column.name: parts[column.field, column.part]
        for column in columns
        if (column.field, column.part) in parts
    }


def _parts(field: Field, value: Any) -> Iterator[tuple[str, Any]]:
    names = part_names(field)
    if not names:
        yield "", in_list(field, value)
        return
    flat = [part for group in value for part in group] if field.each else value
    if field.kind == "text":
        flat = value
    for index, name in enumerate(names):
        yield name, plain(field, index, flat[index])


def plain(field: Field, index: int, value: Any) -> Any:
    """Return one number of a field as a column holds it: an enum's member is its name."""
    if field.kind == "enum" and field.labels:
        return field.labels[field.choices.index(value)]
    if field.kind == "text":
        return value
    number = field.cases[0].numbers[index]
    if number.kind == "enum" and number.labels:
        return number.labels[number.choices.index(value)]
    return value


def in_list(field: Field, value: Any) -> Any:
    """Return a value as a column of the whole field holds it: tuples are lists."""
    if isinstance(value, tuple):
        return [in_list(field, each) for each in value]
    return value if field.many and field.kind != "enum" else plain(field, 0, value)
