"""Sources, evidence and disputes: where a fact comes from, and what contradicts it."""

from __future__ import annotations

from cobotwire_codegen.language.records import Key, Listed, Record, optional, required
from cobotwire_codegen.language.shapes import Lines, Spans, Text, Word
from cobotwire_codegen.language.words import CONFIDENCE
from cobotwire_codegen.load import Node


def source() -> Key[Spans]:
    """Return the key that names lines of the protocol document."""
    return optional(Lines(), "Lines of the protocol document that state this.")


class Evidence(Record):
    """What one source states about a fact."""

    source = required(Text(), "The source: `document`, a library with its version, a capture.")
    says = required(Text(), "What the source states.")
    lines = optional(Lines(), "The lines that state it, if the source is the document.")
    EXAMPLE = '{source: document, lines: [416, 417], says: "x1000 for a length"}'


NO_EVIDENCE = ("no-evidence", "name at least one source")


class Dispute(Record):
    """A fact on which the sources disagree. It is shown in the generated reference."""

    claim = required(Text(), "The fact, as this edition reads it.")
    reading = required(Text(), "The claim as a formula or in a few words.")
    confidence = required(Word(CONFIDENCE), "How certain the reading is.")
    about = optional(
        Text(),
        "The part and the aspect that the dispute is about, written as in evidence files: "
        "`reply/length`. Observations of arms then raise or lower the confidence.",
    )
    evidence = required(Listed(Evidence, NO_EVIDENCE), "What each source states.", NO_EVIDENCE[0])
    EXAMPLE = """\
claim: The reply carries tenths of a degree.
reading: x10
confidence: medium
evidence:
  - {source: document, lines: [1087], says: "the example has one decimal"}
  - {source: a capture, says: "235 at 23.5 degrees"}
"""


def disputed() -> Key[tuple[Node, ...]]:
    """Return the key that lists the disputes of a type or command."""
    return optional(Listed(Dispute), "Facts on which the sources disagree.")
