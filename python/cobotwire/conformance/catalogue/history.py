"""The versions of the catalogue of test cases.

A test case that is added, removed, reworded or sends something else needs a new version:
``cobotwire-gen --check`` fails until the last entry has the digest of the catalogue. The message
names the entry to add.
"""

from __future__ import annotations

from typing import NamedTuple


class CatalogueVersion(NamedTuple):
    """A version; ``digest`` is that of the catalogue (:func:`listing.digest`)."""

    number: int
    digest: str
    what: str


HISTORY = (
    CatalogueVersion(1, "06c50cbca37d", "the first version with a number"),
    CatalogueVersion(
        2,
        "4b95d75c60b2",
        "new: `replies-in-order`, `others-stay`, `pauses`, `faster`, `limits-kept`, and settings "
        "with values that are not allowed",
    ),
    CatalogueVersion(
        3,
        "041c17935bf7",
        "new: `speeds-reported` and `set-is-reported`; `reply-frame` includes the address; "
        "`reply-repeats` also with and without power; `pauses` includes the report of a pause; "
        "noise comes last among crowded requests",
    ),
    CatalogueVersion(4, "32ce52bee20a", "new: `sent-address`"),
    CatalogueVersion(
        5,
        "bf34366dd252",
        "new: `points-in-order`, and streams with frames around frames; queries that take a "
        "position need one that the device reports",
    ),
    CatalogueVersion(
        6,
        "e023c65db0a3",
        "new: `motion-ended`, `acknowledged-done` and `others-rest`; `reply-once` includes a NUL "
        "with each reply; a test case that must be observed in time is inconclusive if it was not",
    ),
)
VERSION = HISTORY[-1].number
