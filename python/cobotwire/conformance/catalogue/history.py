"""The versions of the catalogue of test cases.

A report names test cases also by the number of a clause. The number of a test case never changes,
and that of a removed one is not given again: new test cases are added at the end of ``CLAUSES``.

A test case that is added, removed, reworded or sends something else needs a new version:
``cobotwire-gen --check`` fails until the last entry has the digest of the catalogue. The message
names the entry to add.
"""

from __future__ import annotations

from typing import NamedTuple


class CatalogueVersion(NamedTuple):
    """A version; ``digest`` is that of the catalogue (:func:`listing.digest`).

    ``clauses`` is how many clauses there were, and ``of_clauses`` their digest; None: they had no
    numbers.
    """

    number: int
    digest: str
    what: str
    clauses: int | None = None
    of_clauses: str = ""


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
    CatalogueVersion(
        7,
        "1a222ef05899",
        "test cases have clause numbers; `expected-failure` also for devices and clients",
        84,
        "57e07a421a41",
    ),
    CatalogueVersion(
        8,
        "4479e68d624a",
        "new: `list-cleared`; `effect` includes what an argument chooses, `points-in-order` lists "
        "that nothing counts, `read-back` what a case stores by an index; `reply-repeats` with "
        "power only where a command switches it",
        85,
        "bbcba3667264",
    ),
)
VERSION = HISTORY[-1].number

# The test cases by the number of their clause, from 1.
_NUMBERED = """
query-replied reply-frame reply-fields reply-echo reply-once reply-repeats declared-absent
geometry reached limits wrong-length wrong-footer cut-request recovers state-kept out-of-range
request-in-pieces two-in-one-write noise-before replies-in-order unknown-id read-back
neighbours-stay restored one-way-silent acknowledgement change-replied set-is-reported
points-in-order others-stay reference-shifts arrives moving stops motion-ended others-rest pauses
faster speeds-reported limits-kept effect acknowledged-done agrees acknowledgements-alike
declared-firmware declared-acknowledgements expected-failure frame-length frame-id frame-footer
frame-address frame-whole stray-bytes interleaved-write text-follows motion-resent change-resent
motion-powered reply-awaited reply-given-time late-reply-expected value-range value-listed
sent-scale sent-sign sent-byte-order sent-order sent-rounded sent-value sent-address sent-variant
sent-once sent-all sent-nothing-else encode-bytes encode-rejects decode-values decode-rejects
rejection-reason stream-frames stream-chunks stream-noise noise-reason answers list-cleared
"""
CLAUSES = tuple(_NUMBERED.split())
NUMBERS = {case: number for number, case in enumerate(CLAUSES, 1)}
