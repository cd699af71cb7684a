"""Encode messages from fields by name, and return fields by name, for the line protocol."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Direction


def encode_named(
    codec: Codec, command: str, direction: Direction, fields: Mapping[str, Any]
) -> bytes:
    """Return the frame of the first variant with exactly these fields that allows the values.

    Raises:
        UsageError: no variant has these fields, or none allows the values.
    """
    rejection: UsageError | None = None
    for index, variant in enumerate(codec.table.command(command).variants(direction)):
        names = [field.name for field in variant.fields]
        if set(names) != set(fields):
            continue
        values = [
            bool(fields[field.name])
            if field.kind == "flag" and fields[field.name] in (0, 1)
            else fields[field.name]
            for field in variant.fields
        ]
        try:
            return codec.encode(command, direction, values, variant=index)
        except UsageError as error:
            rejection = rejection or error
    raise rejection or UsageError(
        f"{command} {direction}: fields", sorted(fields), "those of a variant"
    )


def plain_fields(message: DecodedMessage) -> dict[str, Any]:
    """Return the values of a message by name, as JSON values: flags and enums as integers."""
    return {name: _plain(value) for name, value in message.fields.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    return value if isinstance(value, float) else int(value)
