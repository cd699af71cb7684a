"""The model as versioned JSON, so that anyone can write a generator in any language.

``version`` counts up when a reader of the old form could misread the new one. Exact numbers are
strings: ``"1/100"``.
"""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model import Edition

VERSION = 1


def model_json(edition: Edition) -> str:
    """The whole model of an edition."""
    data = {"format": "cobotwire-model", "version": VERSION, "edition": _plain(edition)}
    return json.dumps(data, indent=1) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, Place):
        return str(value)
    if isinstance(value, Fraction):
        return str(value)
    if isinstance(value, bytes):
        return value.hex(" ").upper()
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    if is_dataclass(value) and not isinstance(value, type):
        record = {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
        # A quantity, an enum, a flag and a named tuple stand in the same place: say which it is.
        return {"kind": type(value).__name__.lower(), **record}
    return value
