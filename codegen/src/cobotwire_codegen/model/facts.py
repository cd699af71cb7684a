"""Where a fact comes from, what speaks against it, and what a delta did to it."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire_codegen.errors import Place

# Spans of lines of the document, first and last.
Lines = tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class Evidence:
    """One source's word on a disputed fact."""

    source: str
    lines: Lines
    says: str


@dataclass(frozen=True, slots=True)
class Dispute:
    """A fact that the sources do not agree on."""

    place: Place
    claim: str
    reading: str
    confidence: str
    evidence: tuple[Evidence, ...]


@dataclass(frozen=True, slots=True)
class Change:
    """What a delta edition does to its base, in words, and why."""

    place: Place
    what: str
    why: str
    evidence: tuple[Evidence, ...]
