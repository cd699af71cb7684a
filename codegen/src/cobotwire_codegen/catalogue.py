"""The catalogue of checks: sums, XOR, Fletcher's checksums, and every CRC of Greg Cook's catalogue.

``anycrc`` holds the parameters of the CRCs; this is its only importer. The codecs get the
parameters, and compute the CRCs themselves.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

import anycrc

from cobotwire_codegen.errors import nearest

# The widths in bytes of the checks that are not CRCs; the first one is the default.
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
CATALOGUE = "https://reveng.sourceforge.io/crc-catalogue/all.htm"
# Documents use these names for several CRCs; the catalogue lists each for one of them only.
_CCITT = ("crc16-kermit", "crc16-ibm-3740", "crc16-xmodem")
_SEVERAL: dict[str, tuple[str, ...]] = {"crc16ccitt": _CCITT, "crcccitt": _CCITT}
_SEVERAL |= dict.fromkeys(("crc16", "crc16ibm", "crcibm"), ("crc16-arc", "crc16-modbus", *_CCITT))


def _plain(name: str) -> str:
    return re.sub("[^a-z0-9]", "", name.lower())


_ALIASES = {_plain(alias): (name.lower(),) for alias, name in anycrc.aliases.items()}
_KNOWN_AS = {_plain(name): (name,) for name in CRCS} | _ALIASES | _SEVERAL


def value_shown(name: str) -> str:
    """Return the CRC of ``123456789`` in hex digits."""
    return f"{CRCS[name].check:0{-(-CRCS[name].width // 4)}X}"


def check_hint(given: str, others: Iterable[str]) -> str:
    """Return a hint for an unknown check; ``others`` are the checks that are not CRCs.

    The CRC with the most similar name may be the wrong one, so the hint does not suggest it.
    """
    value = "the CRC of the ASCII digits 123456789"
    if named := _KNOWN_AS.get(_plain(given)):
        words = " or ".join(f"{name} ({value_shown(name)})" for name in named)
        return f"; did you mean {words}? In parentheses is {value}"
    if "did you mean" in (hint := nearest(given, others)):
        return hint
    return f"{hint}, and the CRCs of {CATALOGUE}: to find yours, compare {value}"
