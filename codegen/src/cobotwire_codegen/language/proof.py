"""Vectors and errata: what the spec is compared with."""

from __future__ import annotations

from cobotwire_codegen.language import facts
from cobotwire_codegen.language.names import METHOD
from cobotwire_codegen.language.number_shapes import Whole
from cobotwire_codegen.language.records import Choice, Listed, Part, Record, optional, required
from cobotwire_codegen.language.shapes import Anything, Hex, Lines, Name, Text, Texts, Word
from cobotwire_codegen.language.words import ERRATUM_KINDS, REASONS, VERDICTS


class Rejection(Record):
    """Why the printed bytes are not a legal frame."""

    reason = required(Word(REASONS), "The framer's reason.")
    offset = required(Whole(0), "The offset of the first byte that is not legal.")
    EXAMPLE = "{reason: bad-length, offset: 2}"


_VALUES = Anything(
    "a mapping from fields to lists of values",
    {"type": "object", "additionalProperties": {"type": "array", "minItems": 1}},
)


class _Vector(Record):
    command = required(Name(METHOD), "The command that it shows.")
    direction = required(Word(("request", "reply")), "Which of its messages.")
    line = optional(Whole(1), "Its line in the document.", 0)
    printed = optional(Hex(), "The bytes that the document prints.")
    frame = optional(
        Hex(),
        "The frame to encode and to decode; it may carry any legal address. Left out: the document "
        "prints bytes that belong elsewhere.",
    )
    text = optional(Text(), "The text of a reply outside any frame, instead of `frame`.")
    values = optional(
        Anything("a mapping from fields to values", {"type": "object"}),
        "The values of the fields, in order: an enum by its member, a flag as true or false, a "
        "value type as a list.",
    )
    accepted = optional(
        _VALUES, "Other values that a field accepts in place of its own: the ends of its range."
    )
    refused = optional(
        _VALUES, "Values that a field refuses in place of its own: those beyond its range."
    )
    says = optional(Text(), "What it shows.")
    rejected = optional(Part(Rejection), "Why the printed bytes are not a legal frame.")
    source = facts.source()
    why = optional(Text(), "Where it comes from.")


class NamedVector(_Vector):
    """A frame with the values that it carries."""

    HEADING = "Vector"
    name = required(Text(), "Its name.")
    EXAMPLE = """\
name: get_speed-request
command: get_speed
direction: request
frame: FE FE 02 40 FA
values: {}
"""


class ExampleVector(_Vector):
    """An example that the document prints."""

    HEADING = "Example vector"
    example = required(Whole(1), "Its number among the document's examples, from 1.")
    verdict = required(Word(VERDICTS), "Whether the printed bytes are right.")
    EXAMPLE = """\
example: 15
line: 288
command: send_angle
direction: request
printed: FE FE 06 21 01 00 00 14 FA
verdict: consistent
frame: FE FE 06 21 01 00 00 14 FA
values: {joint: 1, angle: 0, speed: 20}
says: No.1 to zero position
"""


VECTOR = Choice("vector", {"example": ExampleVector}, NamedVector)


class VectorsFile(Record):
    """Frames with the values that they carry."""

    vectors = required(Listed(VECTOR), "The vectors.")


class Erratum(Record):
    """A place where the document is wrong or contradicts itself, and how it is read."""

    line = required(Lines(), "The lines of the document.")
    kind = required(Word(ERRATUM_KINDS), "What is wrong.")
    says = required(Text(), "What the document states there.")
    read = required(Text(), "How it is read instead.")
    why = required(Text(), "The reason.")
    commands = optional(Texts(), "The commands. Left out: the frame or the transport.")
    example = optional(Whole(1), "The number of the example that is wrong.", 0)
    EXAMPLE = """\
line: 386
kind: text
commands: [get_coords]
example: 20
says: "x coordinate ... divided by 100"
read: "divided by 10"
why: "line 417's own example is x10"
"""


class ErrataFile(Record):
    """The places where the document is wrong or contradicts itself."""

    errata = required(Listed(Erratum), "The errata.")
