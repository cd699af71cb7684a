"""Hold the JSON schemas of MCAP channels: Foxglove's well-known ones, and those of our messages.

Foxglove knows a schema by its name; the fields are those of
https://docs.foxglove.dev/docs/sdk/schemas.
"""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from cobotwire.capture.export.tables import OWN

Schema = dict[str, Any]

_NUMBER: Schema = {"type": "number"}
_TIME: Schema = {
    "type": "object",
    "title": "time",
    "properties": {
        "sec": {"type": "integer", "minimum": 0},
        "nsec": {"type": "integer", "minimum": 0, "maximum": 999_999_999},
    },
}


def _object(title: str, required: bool = True, **properties: Schema) -> Schema:
    schema = {"title": title, "type": "object", "properties": properties}
    return {**schema, "required": list(properties)} if required else schema


_JOINT_STATE: Schema = {
    **_object("foxglove.JointState", False, name={"type": "string"}, position=_NUMBER),
    "required": ["name"],
}
JOINT_STATES = _object(
    "foxglove.JointStates", timestamp=_TIME, joints={"type": "array", "items": _JOINT_STATE}
)
_POSE = _object(
    "foxglove.Pose",
    position=_object("foxglove.Vector3", x=_NUMBER, y=_NUMBER, z=_NUMBER),
    orientation=_object("foxglove.Quaternion", x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER),
)
POSE_IN_FRAME = _object(
    "foxglove.PoseInFrame", timestamp=_TIME, frame_id={"type": "string"}, pose=_POSE
)


def of_table(title: str, schema: Any) -> Schema:
    """Return the schema of the messages of an Arrow schema: its fields, without our columns."""
    fields = {field.name: _of_field(field) for field in schema if field.name not in OWN}
    return _object(title, False, **fields)


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
