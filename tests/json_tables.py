"""Load the sample tables with features that no edition has, from ``tests/found``."""

from __future__ import annotations

import json
from functools import lru_cache

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Check, Crc, Table
from strategies import TABLES
from vectors import ROOT

CRC16_MODBUS = Check("crc", "header", 2, "big", Crc(16, 0x8005, 0xFFFF, True, True, 0))
SUM_OF_DATA = Check("sum", "command")
FOUND = ROOT / "tests" / "found"


@lru_cache
def codec_of(name: str, kind: codecs.CodecName) -> Codec:
    """Return a codec of an edition or of a sample, cached."""
    return codecs.load(TABLES.get(name) or sample(name), kind)


def sample(name: str) -> Table:
    """Return the table of a sample."""
    return table_of(json.loads((FOUND / f"{name}.json").read_text()))
