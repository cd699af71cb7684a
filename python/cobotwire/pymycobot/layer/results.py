"""Gives results of our client as the maker's library gives them.

``plain`` is the usual one; ``spec/pymycobot.yaml`` names the others by these functions' names.
"""

from __future__ import annotations

import math
from typing import Any

from cobotwire.protocol.errors import ProtocolError

# An error register of seven bytes: the first and the last code of each class of the library.
_CLASSES = ((1, 16, 22), (2, 23, 28), (3, 32, 111))

# What the library returns where an arm sends minus ten radians, in thousandths or hundredths.
NO_SOLUTION, NO_ANGLES = "No solution for conversion", {-572.957, -572.95}

# What a 320 reports for a register of a servo that could not be read.
NO_REGISTER = 255


def plain(value: Any) -> Any:
    """Return lists instead of tuples, and numbers instead of flags and enums."""
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return int(value) if isinstance(value, int) else value


def listed(value: Any) -> Any:
    """Return a list, also of one number."""
    found = plain(value)
    return found if isinstance(found, list) else [found]


def nothing(value: Any) -> None:
    """Return None, although the request was acknowledged."""


def joined(value: Any) -> Any:
    """Return the numbers of all named tuples in one list."""
    return [item for part in plain(value) for item in part]


def radians(value: Any) -> Any:
    """Round degrees to hundredths, convert them to radians, and round these to thousandths."""
    return [round(math.degrees(each) * (math.pi / 180), 3) for each in value]


def bit_numbers(value: Any) -> Any:
    """Return, for each number, the list of its set bits, the lowest first; 0 if none is set."""
    return [[bit for bit in range(16) if word >> bit & 1] or 0 for word in plain(value)]


def error_classes(value: Any) -> Any:
    """Return the set bits of each byte's class for seven bytes; for six, three signed words."""
    if len(value) == 7:
        return bit_numbers([_error_class(byte) for byte in value])
    data = bytes(value)
    return [int.from_bytes(data[at : at + 2], "big", signed=True) for at in (0, 2, 4)]


def _error_class(byte: int) -> int:
    return next((name for name, first, last in _CLASSES if first <= byte <= last), byte)


def points(value: Any) -> Any:
    """Return two lists: the numbers at even and at odd indices; -1 if all are 0."""
    numbers = plain(value)
    return [numbers[::2], numbers[1::2]] if any(numbers) else -1


def words_of_text(value: Any) -> Any:
    """Return the first word of the first text, and the last word of the last."""
    words = [text.split(" ") for text in value]
    return words[0][0], words[-1][-1]


def bytes_listed(value: Any) -> Any:
    """Return the bytes as a list; a single one as a number."""
    return value[0] if len(value) == 1 else list(value)


def numbers(value: Any) -> Any:
    """Return the bytes as a list."""
    return list(value)


def tenths(value: Any) -> Any:
    """Return a tenth of a number."""
    return value / 10


def pairs(value: Any) -> Any:
    """Return a list of pairs: two numbers in each."""
    numbers = plain(value)
    return [numbers[at : at + 2] for at in range(0, len(numbers), 2)]


def calibrated(value: Any) -> Any:
    """Return 1 if all joints are calibrated, else a number for each joint."""
    every, joints = plain(value)
    return 1 if every else joints


def bits_from_the_highest(value: Any) -> Any:
    """Return, for each number, the list of its set bits, the highest first; 0 if none is set."""
    return [bits and bits[::-1] for bits in bit_numbers(value)]


def robot_status(value: Any) -> Any:
    """Return all numbers in one list; the error words as lists of set bits, the highest first."""
    *flags, limits, motors, software = plain(value)
    return [*flags, *limits, *bits_from_the_highest([*motors, *software])]


def quick_move_info(value: Any) -> Any:
    """Return the rows, two zeros, and the further bytes after the first two."""
    angles, coords, further = plain(value)
    return [angles, coords, 0, 0, *further[2:]]


def in_hundredths(value: Any) -> Any:
    """Return whole numbers of hundredths."""
    return [round(each * 100) for each in value]


def signed(value: Any) -> Any:
    """Return words of two bytes as signed numbers."""
    return [each - 0x10000 if each >= 0x8000 else each for each in plain(value)]


def solved(value: Any) -> Any:
    """Return the angles; a text if the arm sends minus ten radians of each joint."""
    found = plain(value)
    return NO_SOLUTION if set(found) <= NO_ANGLES else found


def hex_text(value: Any) -> Any:
    """Return a number as four hex digits."""
    return f"{value:04X}"


def calibrated_joints(value: Any) -> Any:
    """Return 1 if everything is calibrated, else all numbers in one list."""
    every, joints = plain(value)
    flags = [every, *joints]
    return 1 if all(flags) else flags


def robot_status_of_450(value: Any) -> Any:
    """Return all numbers in one list; the error words as lists of set bits, the lowest first."""
    *flags, limits, motors, software = plain(value)
    return [*flags, *limits, *bit_numbers((*motors, *software))]


def flat(value: Any) -> Any:
    """Return all numbers in one list."""
    parts = plain(value)
    return [each for part in parts for each in (part if isinstance(part, list) else [part])]


def servo_register(value: Any) -> Any:
    """Return the number in a register of a servo.

    Raises:
        ProtocolError: it is 255, which the library takes for a read that failed.
    """
    if value == NO_REGISTER:
        text = "the register of the servo could not be read: the arm reports 255"
        raise ProtocolError("bad-value", 0, bytes([NO_REGISTER]), text)
    return plain(value)


def in_thousandths(value: Any) -> Any:
    """Return whole numbers of thousandths."""
    return [round(each * 1000) for each in value]


def listed_hundredths(value: Any) -> Any:
    """Return a list of one whole number of hundredths."""
    return [round(value * 100)]
