"""Make a JSON schema for each MCAP channel; a channel carries one message of a table."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from cobotwire.capture.export.tables import OWN

Schema = dict[str, Any]


def of_table(title: str, schema: Any) -> Schema:
    """Return the JSON schema for an Arrow schema, without the columns that the export adds."""
    fields = {field.name: _of_field(field) for field in schema if field.name not in OWN}
    return {"title": title, "type": "object", "properties": fields}


def _of_field(field: Any) -> Schema:
    schema = _of_type(field.type)
    if unit := (field.metadata or {}).get(b"unit"):
        schema["description"] = unit.decode()
    return schema


def _of_type(kind: Any) -> Schema:
    if pa.types.is_boolean(kind):
        return {"type": "boolean"}
    if pa.types.is_integer(kind):
        return {"type": "integer"}
    if pa.types.is_floating(kind):
        return {"type": "number"}
    if pa.types.is_list(kind) or pa.types.is_fixed_size_list(kind) or pa.types.is_large_list(kind):
        return {"type": "array", "items": _of_type(kind.value_type)}
    # Texts, names of enums, and bytes, which are hex.
    return {"type": "string"}
