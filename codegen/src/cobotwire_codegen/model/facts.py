"""Evidence for a fact, disputes about it, and the changes of a delta."""

from __future__ import annotations

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
    """The versions of a device's firmware on which a command depends; 0: no source names one.

    ``since`` is the first version that has it, ``until`` the first one that lacks it again, and
    ``reply_since`` the first one that replies to it.
    """

    since: Fraction
    until: Fraction
    reply_since: Fraction
    evidence: tuple[Evidence, ...]

    @property
    def versions(self) -> dict[str, Fraction]:
        """The versions that are known, by their names."""
        names = ("since", "until", "reply_since")
        return {name: version for name in names if (version := getattr(self, name))}


@dataclass(frozen=True, slots=True)
class Dispute:
    """A fact on which the sources disagree; ``about`` is its part and aspect, or empty."""

    place: Place
    claim: str
    reading: str
    confidence: str
    evidence: tuple[Evidence, ...]
    about: str = ""


@dataclass(frozen=True, slots=True)
class ObservedFact:
    """What an arm showed of a fact, COMMAND/PART/ASPECT; ``confirmed``: it is as stated."""

    place: Place
    fact: str
    confirmed: bool
    why: str
    frames: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Observation:
    """What one arm showed, in a file of evidence; ``vectors`` are names of vectors."""

    place: Place
    kind: str
    robot: str
    firmware: str
    date: str
    digest: str
    facts: tuple[ObservedFact, ...]
    vectors: tuple[str, ...]

    @property
    def source(self) -> str:
        """The source, as evidence names it."""
        firmware = f", firmware {self.firmware}" if self.firmware else ""
        return f"a {self.kind} of a real arm, {self.date}: {self.robot}{firmware}"


@dataclass(frozen=True, slots=True)
class Change:
    """What a delta changes in its base, in words, and the reason."""

    place: Place
    what: str
    why: str
    evidence: tuple[Evidence, ...]
