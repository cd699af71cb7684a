"""Guess the kind of mistake from the numbers that were expected and those received."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from cobotwire.protocol.table import Number

# A wrong scale multiplies all numbers by one of these factors, within a tenth.
FACTORS = {
    **{factor: f"{factor:g} times the right number" for factor in (10.0, 100.0, 1000.0)},
    **{1 / factor: f"{1 / factor:g} times the right number" for factor in (10.0, 100.0, 1000.0)},
    1 / 57.3: "the right number in radians",
    57.3: "the right number, taken for radians",
}
NEAR_FACTOR = 0.1
ANOTHER_ORDER = "the right numbers in another order"


class Pair(NamedTuple):
    """The right number, and the number that was received.

    ``near`` is the largest difference between two readings of the same quantity. ``number`` is how
    the number is sent; None: it was converted.
    """

    name: str
    right: float
    received: float
    near: float
    number: Number | None = None

    @property
    def wrong(self) -> bool:
        """Whether the number is wrong."""
        return not _close(self.received, self.right, self.near)

    @property
    def exchanged(self) -> Pair:
        """The pair with its two numbers exchanged."""
        return self._replace(right=self.received, received=self.right)


def likely_mistake(pairs: Sequence[Pair]) -> str:
    """Return the mistake that explains all wrong numbers of a reply; empty if none does."""
    wrong = [pair for pair in pairs if pair.wrong]
    return next(_explanations(pairs, wrong), "") if wrong else ""


def _explanations(pairs: Sequence[Pair], wrong: Sequence[Pair]) -> Iterator[str]:
    names = " and ".join(pair.name for pair in wrong)
    if _is_other_order(wrong):
        backwards = [pair.right for pair in pairs][::-1]
        if len(wrong) == 2:
            yield f"{names} are swapped"
        elif all(_close(p.received, back, p.near) for p, back in zip(pairs, backwards)):
            yield "the right numbers in reverse order"
    if len(wrong) > 2 and _is_one_behind(pairs):
        yield "each is the number that was right for the request before"
    if len(wrong) > 2 and _is_other_order(wrong):
        yield ANOTHER_ORDER
    if all(map(_has_bytes_swapped, wrong)):
        yield f"{names}: the right numbers with their bytes swapped"
    if all(_close(pair.received, -pair.right, pair.near) for pair in wrong):
        yield f"{names}: the right numbers with the other sign"
    for factor, words in FACTORS.items():
        if all(_is_times(pair, factor) for pair in wrong):
            yield f"{names}: {words}"


def _is_other_order(wrong: Sequence[Pair]) -> bool:
    """Return whether the wrong numbers are the right ones, each elsewhere."""
    if len(wrong) < 2:
        return False
    received, right = sorted(p.received for p in wrong), sorted(p.right for p in wrong)
    near = max(pair.near for pair in wrong)
    return all(_close(a, b, near) for a, b in zip(received, right))


def _is_one_behind(pairs: Sequence[Pair]) -> bool:
    """Return whether each received number, except the first, was right in the pair before it."""
    return all(_close(now.received, old.right, now.near) for old, now in pairwise(pairs))


def _is_times(pair: Pair, factor: float) -> bool:
    """Return whether the number was multiplied, perhaps beyond what its bytes can hold."""
    scaled = pair.right * factor
    apart = pair.received - scaled
    most = max(pair.near * min(factor, 1.0), abs(scaled) * NEAR_FACTOR)
    if pair.number is not None and pair.number.encoding == "integer" and not pair.number.bits:
        turn = abs(pair.number.physical(256**pair.number.width))
        apart -= round(apart / turn) * turn
        # The tolerance of a huge number would accept nearly every number.
        most = min(most, turn / 16)
    return abs(apart) <= most


def _has_bytes_swapped(pair: Pair) -> bool:
    number = pair.number
    if number is None or number.width < 2 or number.encoding == "float" or number.bits:
        return False
    swapped = number.pack(round(number.steps(pair.right)))[::-1]
    return _close(pair.received, number.physical(number.unpack(swapped)), pair.near)


def _close(one: float, other: float, near: float) -> bool:
    return abs(one - other) <= near
