"""The closed lists of words that a spec may use."""

from __future__ import annotations

SAFETY = ("query", "setting", "motion", "power", "persistent write")
CHECKS = ("footer", "crc16-modbus", "sum")
ROLES = (
    "joint targets",
    "joint target",
    "coordinate targets",
    "coordinate target",
    "reached",
    "moving",
    "stop",
    "joints",
    "coordinates",
    "powered",
    "version",
)
UNITS = (
    "degree",
    "degree_celsius",
    "hertz",
    "millimetre",
    "milliampere",
    "percent",
    "step_per_second",
    "tick",
    "volt",
)
CONFIDENCE = ("high", "medium", "low")
VERDICTS = ("consistent", "erratum", "label only", "text and byte disagree")
REASONS = (
    "no-header",
    "bad-address",
    "bad-length",
    "unknown-id",
    "bad-check",
    "truncated",
    "trailing",
    "bad-value",
)
ERRATUM_KINDS = ("text", "table", "title", "label", "example", "missing")
