"""The versions of the catalogue of test cases.

Reports also name a test case by the number of its clause. A number never changes and is never
reused, so new test cases are added at the end of ``CLAUSES``.

A test case that is added, removed, reworded or sends something else needs a new version:
``tests/conformance/test_catalogue.py`` and ``make docs`` fail until the last entry has the digest
of the catalogue. The message names the entry to add.
"""

from __future__ import annotations

from typing import NamedTuple


class CatalogueVersion(NamedTuple):
    """A version; ``digest`` is the digest of the catalogue (:func:`listing.digest`).

    ``what`` says what has changed. ``clauses`` is the number of clauses in that version, and
    ``of_clauses`` the digest of their names.
    """

    number: int
    digest: str
    what: str
    clauses: int
    of_clauses: str


HISTORY = (CatalogueVersion(1, "a1e4300002b6", "the first version", 85, "bbcba3667264"),)
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
