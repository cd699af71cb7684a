"""The likely mistake is derived from the right numbers of a row and the received ones."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from cobotwire.conformance.mistakes import Pair, likely_mistake
from cobotwire.editions.mycobot import TABLE

NUMBERS = TABLE.command("get_angles").reply[0].fields[0].cases[0].numbers
RIGHT = (17.57, -13.18, 7.91, 26.36, -5.27, 36.03)


def guess(received: Sequence[float], right: Sequence[float] = RIGHT) -> str:
    rows = zip(NUMBERS, right, received)
    return likely_mistake([Pair(number.name, a, b, 0.1, number) for number, a, b in rows])


@pytest.mark.parametrize(
    ("received", "words"),
    [
        (RIGHT, ""),
        ([n + 0.05 for n in RIGHT], ""),
        ([n / 10 for n in RIGHT], "0.1 times the right number"),
        ([n / 57.2958 for n in RIGHT], "in radians"),
        ([-n for n in RIGHT], "with the other sign"),
        ((17.57, -13.18, 7.91, -5.27, 26.36, 36.03), "j4 and j5 are swapped"),
        (RIGHT[::-1], "in reverse order"),
        ((RIGHT[1], RIGHT[2], RIGHT[0], *RIGHT[3:]), "in another order"),
        ((99.0, *RIGHT[:5]), "right for the request before"),
        ((17.57, 55.5, *RIGHT[2:]), ""),
        ((17.57, 13.18, *RIGHT[2:]), "j2: the right numbers with the other sign"),
    ],
)
def test_likely_mistake_names_what_explains_all_wrong_numbers(
    received: Sequence[float], words: str
) -> None:
    assert words in guess(received) if words else guess(received) == ""


def test_swapped_bytes_are_recognised() -> None:
    swapped = [
        number.physical(number.unpack(number.pack(round(number.steps(n)))[::-1]))
        for number, n in zip(NUMBERS, RIGHT)
    ]
    assert "bytes swapped" in guess(swapped)


def test_wrong_scale_beyond_what_the_bytes_hold_is_recognised() -> None:
    number = NUMBERS[0]
    tenfold = [
        number.physical(number.unpack(number.pack(round(10 * number.steps(n))))) for n in RIGHT
    ]
    assert "10 times" in guess(tenfold)
