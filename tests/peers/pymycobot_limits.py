"""Call pymycobot with the values of a vector, to see which it sends and which it refuses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from cobotwire_codegen.model import Command
from pymycobot_classes import REJECTIONS, without_port, written
from pymycobot_difference import M280


def sends(command: Command, values: Mapping[str, Any]) -> bool:
    """Return whether MyCobot280 sends a request with these values."""
    constants = {f.name for variant in command.requests for f in variant if f.const is not None}
    arguments = [_given(value) for name, value in values.items() if name not in constants]
    if "radians" in values:
        arguments[0] = [math.radians(angle) for angle in values["radians"]]
    try:
        written(without_port(M280), command.name, arguments)
    except (*REJECTIONS, IndexError):
        return False
    return True


def _given(value: Any) -> Any:
    # pymycobot takes lists, and neither a bool for 0 or 1 nor 90.0 as a limit.
    if isinstance(value, tuple):
        return [_given(item) for item in value]
    return int(value) if value == int(value) else value
