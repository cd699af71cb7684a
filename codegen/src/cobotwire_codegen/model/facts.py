"""Evidence for a fact, disputes about it, and the changes of a delta."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from cobotwire_codegen.errors import Place

# Ranges of lines of the document, first and last.
Lines = tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class Evidence:
    """What one source states about a fact."""

    source: str
    lines: Lines
    says: str


@dataclass(frozen=True, slots=True)
class Firmware:
    """The versions of a device's firmware on which a command depends, each with its meaning.

    ``versions`` has the keys ``since``, ``until`` and ``reply_since``, as far as they are known.
    """

    versions: Mapping[str, Fraction]
    evidence: tuple[Evidence, ...]


@dataclass(frozen=True, slots=True)
class Dispute:
    """A fact on which the sources disagree."""

    place: Place
    claim: str
    reading: str
    confidence: str
    evidence: tuple[Evidence, ...]


@dataclass(frozen=True, slots=True)
class Change:
    """What a delta changes in its base, in words, and the reason."""

    place: Place
    what: str
    why: str
    evidence: tuple[Evidence, ...]
