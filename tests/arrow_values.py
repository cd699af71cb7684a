"""Say what a table of Arrow must hold, from messages that were decoded one by one."""

from __future__ import annotations

from typing import Any

from cobotwire.codec.events import DecodedMessage
from cobotwire.codec.table_columns import column_name
from cobotwire.protocol.fields import Field


def row(message: DecodedMessage) -> dict[str, Any]:
    """Return the values of a message by column, as Arrow returns them."""
    return {
        column_name(field.name, message.direction): plain(field, value)
        for field, value in zip(message.variant.fields, message.values)
    }


def plain(field: Field, value: Any) -> Any:
    """Return a decoded value as Arrow returns it: members of enums as names, tuples as lists."""
    if isinstance(value, tuple):
        return [plain(field, each) for each in value]
    if field.kind == "enum" and field.labels:
        return field.labels[field.choices.index(value)]
    return value
