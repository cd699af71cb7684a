"""Turn the results of calls into JSON values."""

from __future__ import annotations

from enum import IntEnum
from typing import Any


def as_json_value(value: Any) -> Any:
    """Return a result as JSON values.

    Named tuples, nested ones too, become objects; enum members become their names; bytes become
    pairs of hex digits.
    """
    if hasattr(value, "_asdict"):
        return {name: as_json_value(part) for name, part in value._asdict().items()}
    if isinstance(value, IntEnum):
        return value.name
    if isinstance(value, bytes):
        return value.hex(" ").upper()
    return [as_json_value(part) for part in value] if isinstance(value, tuple) else value
