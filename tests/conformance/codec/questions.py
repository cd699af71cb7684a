"""The questions to codecs of an edition, derived once for all tests."""

from __future__ import annotations

from functools import cache

from cobotwire import editions
from cobotwire.conformance.codec import Question, derive_questions


@cache
def questions_of(edition: str) -> list[Question]:
    """Return all questions; to derive them takes a second."""
    return list(derive_questions(editions.load(edition).TABLE))
