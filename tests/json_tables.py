"""Load the sample tables with features that no edition has, from ``rust/core/tests/samples``."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.table import (
    Case,
    Check,
    Command,
    Crc,
    Field,
    FrameFormat,
    Number,
    Table,
    Variant,
)
from strategies import TABLES
from vectors import ROOT

CRC16_MODBUS = Check("crc", "header", 2, "big", Crc(16, 0x8005, 0xFFFF, True, True, 0))
SUM_OF_DATA = Check("sum", "command")
CHECKS = {"footer": None, "crc16-modbus": CRC16_MODBUS, "sum": SUM_OF_DATA}
SAMPLES = ROOT / "rust" / "core" / "tests" / "samples"


@lru_cache
def codec_of(name: str, kind: codecs.CodecName) -> Codec:
    """Return a codec of an edition or of a sample, cached."""
    return codecs.load(TABLES.get(name) or sample(name), kind)


def sample(name: str) -> Table:
    """Return the table of a sample."""
    return table_of(json.loads((SAMPLES / f"{name}.json").read_text())["table"])


def table_of(record: dict[str, Any]) -> Table:
    """Return the table that plain data describes."""
    frame = record["frame"]
    format = FrameFormat(
        bytes(frame["header"]),
        bytes(frame["footer"]),
        frame["maximum_length"],
        CHECKS[frame.get("check", "footer")],
        tuple(frame.get("addresses", ())),
    )
    return Table(
        **{**record, "frame": format, "commands": tuple(map(_command, record["commands"]))}
    )


def _command(record: dict[str, Any]) -> Command:
    variants = {way: tuple(map(_variant, record.get(way, ()))) for way in ("request", "reply")}
    listed = {name: tuple(record.get(name, ())) for name in ("notes", "arguments")}
    return Command(**{**record, **variants, **listed})


def _variant(record: dict[str, Any]) -> Variant:
    return Variant(tuple(map(_field, record["fields"])))


def _field(record: dict[str, Any]) -> Field:
    rows = {name: tuple(record.get(name, ())) for name in ("choices", "labels")}
    if record.get("default") is not None:
        rows["default"] = tuple(record["default"])
    return Field(**{**record, **rows, "cases": tuple(map(_case, record["cases"]))})


def _case(record: dict[str, Any]) -> Case:
    return Case(tuple(record["when"]), tuple(Number(**number) for number in record["numbers"]))
