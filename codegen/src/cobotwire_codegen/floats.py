"""Converts between IEEE floats and their raw values with exact arithmetic.

The raw value of a float is its rank: 0 for 0.0, 1 for the smallest float above it, -1 for -0.0.
"""

from __future__ import annotations

from fractions import Fraction

# The bits of the fraction by width.
_FRACTION_BITS = {4: 23, 8: 52}


def largest_rank(width: int) -> int:
    """Return the rank of the largest finite float."""
    exponent_bits = 8 * width - 1 - _FRACTION_BITS[width]
    return int((2**exponent_bits - 1) << _FRACTION_BITS[width]) - 1


def exact_of(rank: int, width: int) -> Fraction:
    """Return the value of the finite float with a rank."""
    if rank < 0:
        return -exact_of(-1 - rank, width)
    leading = 1 << _FRACTION_BITS[width]
    exponent, fraction = divmod(rank, leading)
    # With the smallest exponent there is no leading one (subnormals), and the step is that of the
    # next exponent.
    whole = fraction + (leading if exponent else 0)
    return whole * _step(max(exponent, 1), width)


def nearest(value: Fraction, width: int) -> int:
    """Return the rank of the nearest float, ties to even, or of infinity if the value overflows."""
    if value < 0:
        return -1 - nearest(-value, width)
    below = floor(value, width)
    # Rounding treats infinity as the float after the largest one, with the next exponent.
    low = exact_of(below, width)
    high = low + _step(max(below >> _FRACTION_BITS[width], 1), width)
    beyond = value - low > high - value
    tie = value - low == high - value
    return below + int(beyond or (tie and below % 2 == 1))


def floor(value: Fraction, width: int) -> int:
    """Return the rank of the largest float that is not above a value."""
    low, high = -1 - largest_rank(width), largest_rank(width)
    while low < high:
        middle = (low + high + 1) // 2
        if exact_of(middle, width) <= value:
            low = middle
        else:
            high = middle - 1
    return low


def ceiling(value: Fraction, width: int) -> int:
    """Return the rank of the smallest float that is not below a value; -0.0 for zero."""
    return -1 - floor(-value, width)


def _step(exponent: int, width: int) -> Fraction:
    bias = (1 << (8 * width - 2 - _FRACTION_BITS[width])) - 1
    power = exponent - bias - _FRACTION_BITS[width]
    return Fraction(1 << power) if power >= 0 else Fraction(1, 1 << -power)
