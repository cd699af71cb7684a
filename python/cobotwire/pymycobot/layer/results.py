"""Gives results of our client as the maker's library gives them.

``plain`` is the usual one; ``spec/pymycobot.yaml`` names the others by these functions' names.
"""

from __future__ import annotations

import math
from typing import Any

# An error register of seven bytes: the first and the last code of each class of the library.
_CLASSES = ((1, 16, 22), (2, 23, 28), (3, 32, 111))


def plain(value: Any) -> Any:
    """Return lists instead of tuples, and numbers instead of flags and enums."""
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return int(value) if isinstance(value, int) else value


def listed(value: Any) -> Any:
    """Return a list of one number."""
    return [plain(value)]


def nothing(value: Any) -> None:
    """Return None, although the order was acknowledged."""


def joined(value: Any) -> Any:
    """Return the parts of all named tuples in one list."""
    return [item for part in plain(value) for item in part]


def radians(value: Any) -> Any:
    """Return radians of degrees that were rounded to hundredths, rounded to thousandths."""
    return [round(math.degrees(each) * (math.pi / 180), 3) for each in value]


def bit_numbers(value: Any) -> Any:
    """Return for each byte the numbers of the bits that are set, or 0."""
    return [[bit for bit in range(8) if byte >> bit & 1] or 0 for byte in value]


def error_classes(value: Any) -> Any:
    """Return for each of seven bytes the bits of its class; six bytes as three signed words."""
    if len(value) == 7:
        return bit_numbers([_error_class(byte) for byte in value])
    data = bytes(value)
    return [int.from_bytes(data[at : at + 2], "big", signed=True) for at in (0, 2, 4)]


def _error_class(byte: int) -> int:
    return next((name for name, first, last in _CLASSES if first <= byte <= last), byte)


def points(value: Any) -> Any:
    """Return every second number in one list and the others in another; -1 if all are 0."""
    numbers = plain(value)
    return [numbers[::2], numbers[1::2]] if any(numbers) else -1


def words_of_text(value: Any) -> Any:
    """Return the first word of the first text, and the last word of the last."""
    words = [text.split(" ") for text in value]
    return words[0][0], words[-1][-1]
