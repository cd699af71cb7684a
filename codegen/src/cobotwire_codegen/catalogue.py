"""The catalogue of checks: sums, XOR, Fletcher's checksums, and every CRC of Greg Cook's catalogue.

``anycrc`` holds the parameters of the CRCs; this is its only importer. The codecs get the
parameters, and compute the CRCs themselves.
"""

from __future__ import annotations

from typing import NamedTuple

import anycrc

# The widths in bytes of the checks that are no CRC; the first one is the default.
WIDTHS = {
    "sum": (1, 2, 4),
    "inverted-sum": (1, 2, 4),
    "negated-sum": (1, 2, 4),
    "xor": (1,),
    "fletcher": (2,),
    "fletcher-16": (2,),
}


class Crc(NamedTuple):
    """The parameters of a CRC, and its value for ``123456789``."""

    width: int
    poly: int
    init: int
    refin: bool
    refout: bool
    xorout: int
    check: int


CRCS = {name.lower(): Crc(*model) for name, model in anycrc.models.items()}
