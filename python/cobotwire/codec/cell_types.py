"""Choose the type of the numbers in a column."""

from __future__ import annotations

from cobotwire.protocol.fields import Field

# The integer types of raw columns with their bounds: smaller before larger, unsigned before signed.
_INTEGERS = (
    ("B", 0, 2**8 - 1),
    ("b", -(2**7), 2**7 - 1),
    ("H", 0, 2**16 - 1),
    ("h", -(2**15), 2**15 - 1),
    ("I", 0, 2**32 - 1),
    ("i", -(2**31), 2**31 - 1),
    ("q", -(2**63), 2**63 - 1),
)


def cell_type(field: Field, raw: bool) -> str:
    """Return the type code of a field's column.

    Bytes and text are bytes, physical values 64-bit floats. Raw values have the smallest integer
    type that holds every one that the field allows.
    """
    if not raw:
        return "B" if field.kind in ("bytes", "text") else "d"
    low, high = field.raw_range
    return next(code for code, least, most in _INTEGERS if least <= low and high <= most)
