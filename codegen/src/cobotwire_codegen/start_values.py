"""What queries report before anything has set it, as raw values."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen.model import Command, Field, StartValues
from cobotwire_codegen.wire import raw_values


def reported_fields(command: Command) -> dict[str, Field | None]:
    """Return the fields of a reply that report something: no constants, counts or echoes.

    If variants have a field of the same name, it is that of the first one, which is the full one.
    """
    text = command.text.fields if command.text is not None else ()
    fields = (field for variant in reversed(command.replies) for field in variant)
    return {name: None for name, _ in text} | {
        field.name: field
        for field in fields
        if not (field.echo or field.counts or field.const is not None or field.selector)
    }


def raw_start_values(fields: dict[str, Field | None], stated: StartValues) -> dict[str, Any]:
    """Return the raw values, or the texts, that a query reports at first.

    Raises:
        ValueError: the query reports no such field, or the field has no such value.
    """
    found: dict[str, Any] = {}
    for name, value in stated.values:
        if name not in fields:
            raise ValueError(f"the reply reports no field {name}")
        field = fields[name]
        if field is None:
            found[name] = str(value)
        elif field.type.kind in ("bits", "bytes", "text", "list"):
            raise ValueError(f"{name} is not a number, nor a row of numbers")
        else:
            found[name] = list(raw_values(field.type, name, value))
    return found
