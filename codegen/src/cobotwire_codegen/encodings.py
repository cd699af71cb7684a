"""Define how bytes become raw values: the encodings of numbers.

This module alone knows their rules; the spec language lists them from here.
"""

from __future__ import annotations

from typing import ClassVar

from cobotwire_codegen import floats


class Encoding:
    """Integers of ``width`` bytes. Other encodings are subclasses.

    The bytes of a number are read as an unsigned number, which then becomes the raw value: above
    ``signed_at`` it stands for a negative integer. An encoding without a sign rule ignores
    ``signed_at``. ``what`` names such a number in messages, and ``allowed`` lists its widths.
    """

    what: ClassVar[str] = "an integer"
    doc: ClassVar[str] = "A whole number."
    widths: ClassVar[tuple[int, ...]] = (1, 2, 3, 4)
    allowed: ClassVar[str] = "1..4"
    has_sign_rule: ClassVar[bool] = True

    def bounds(self, width: int, signed_at: int) -> tuple[int, int]:
        """Return the lowest and the highest raw value."""
        top = int(256**width) - 1
        return (signed_at - top if signed_at < top else 0), signed_at

    def raw_of(self, unsigned: int, width: int, signed_at: int) -> int:
        """Return the raw value of an unsigned number."""
        return unsigned if unsigned <= signed_at else unsigned - int(256**width)

    def unsigned_of(self, raw: int, width: int) -> int:
        """Return the unsigned number of a raw value; callers keep its lowest ``width`` bytes."""
        return raw


class Float(Encoding):
    """IEEE floats; a raw value is the rank of the float (see ``floats``)."""

    what = "a float"
    doc = "An IEEE 754 float of 4 or 8 bytes; it has no sign rule."
    widths = (4, 8)
    allowed = "4 or 8"
    has_sign_rule = False

    def bounds(self, width: int, signed_at: int) -> tuple[int, int]:
        """Return the ranks of the lowest and the highest finite float."""
        largest = floats.largest_rank(width)
        return -1 - largest, largest

    def raw_of(self, unsigned: int, width: int, signed_at: int) -> int:
        """Return the rank of the float with these bits."""
        half = 256**width // 2
        return unsigned if unsigned < half else half - 1 - unsigned

    def unsigned_of(self, raw: int, width: int) -> int:
        """Return the bits of the float with this rank."""
        return raw if raw >= 0 else 256**width // 2 - 1 - raw


# The encodings by their names in specs; the first one is the default.
ENCODINGS: dict[str, Encoding] = {"integer": Encoding(), "float": Float()}
