"""Messages by the names of their fields, as the line protocol speaks of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.codec.interface import Codec, Message
from cobotwire.errors import UsageError
from cobotwire.table import Direction


def encode_named(
    codec: Codec, command: str, direction: Direction, fields: Mapping[str, Any]
) -> bytes:
    """Build the frame of the first form that has just these fields and takes the values.

    Raises:
        UsageError: no form does.
    """
    refusal: UsageError | None = None
    for index, form in enumerate(codec.table.command(command).layouts(direction)):
        names = [field.name for field in form.fields]
        if set(names) != set(fields):
            continue
        values = [
            bool(fields[field.name])
            if field.kind == "flag" and fields[field.name] in (0, 1)
            else fields[field.name]
            for field in form.fields
        ]
        try:
            return codec.encode(command, direction, values, form=index)
        except UsageError as error:
            refusal = refusal or error
    raise refusal or UsageError(f"{command} {direction}: fields", sorted(fields), "those of a form")


def plain_fields(message: Message) -> dict[str, Any]:
    """The values of a message by name, as JSON has them: flags and enums as whole numbers."""
    return {name: _plain(value) for name, value in message.fields.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    return value if isinstance(value, float) else int(value)
