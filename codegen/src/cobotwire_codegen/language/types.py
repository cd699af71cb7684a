"""The types file: the types of fields."""

from __future__ import annotations

from cobotwire_codegen.encodings import ENCODINGS
from cobotwire_codegen.language import facts
from cobotwire_codegen.language.meanings import MeaningsOfNumbers
from cobotwire_codegen.language.names import CLASS, LOWER, UPPER
from cobotwire_codegen.language.number_shapes import Exact, Numbers, Range, Span, Whole
from cobotwire_codegen.language.records import Named, Record, optional, required
from cobotwire_codegen.language.shapes import Known, Name, Text, Word, YesNo
from cobotwire_codegen.units import UNITS

_WIRE = Known("wire_name", "the name of a wire type")
_QUANTITY = Known("quantity_name", "the name of a quantity")
_DOC = "What the type stands for, in a sentence."
_CLASS = "The name of the class in the generated Python."


class Wire(Record):
    """How a raw value is encoded: the number of bytes, their order, and the rule of the sign."""

    HEADING = "Wire type"
    bytes = required(
        Whole(1, 8, "bad-width"), "The number of bytes: 1 to 4 for an integer, 4 or 8 for a float."
    )
    doc = required(Text(), _DOC)
    order = optional(Word(("big", "little")), "Which byte comes first.", "big")
    signed_at = optional(
        Whole(0, code="bad-sign"),
        "The largest raw value. A larger unsigned number n stands for n - 256^bytes, so 32767 is "
        "two's complement in two bytes. Left out: no raw value is negative.",
        -1,
    )
    encoding = optional(
        Word(ENCODINGS, (encoding.doc for encoding in ENCODINGS.values())),
        "What the bytes encode.",
        "integer",
    )
    source = facts.source()
    disputed = facts.disputed()
    EXAMPLE = "{bytes: 2, signed_at: 32767, doc: A signed number of two bytes.}"


class Quantity(Record):
    """A number with a scale, a unit and a range: physical value = raw value x scale."""

    wire = required(_WIRE, "How the raw value is encoded.")
    doc = required(Text(), _DOC)
    scale = optional(Exact(), "The physical value of one raw step: 1/100, 0.01 or 3.")
    unit = optional(
        Word(UNITS, (f"{unit.plural} ({unit.symbol})" for unit in UNITS.values())),
        "The unit of the physical value. Left out: none.",
        "",
    )
    range = optional(
        Range(), "The lowest and highest physical value. Left out: every raw value is legal."
    )
    choices = optional(
        Numbers(), "All legal raw values, if there are only a few. Excludes `range` and `scale`."
    )
    shown_in = optional(
        Word(("radian",)), "The generated methods use radians; the wire carries degrees.", ""
    )
    not_finite = optional(
        YesNo(), "Whether a float may also be infinite or NaN. Excludes `range`.", False
    )
    meanings = optional(
        MeaningsOfNumbers(),
        "What raw values stand for, by raw value or range: `0: no error, 1..6: joint {number} is "
        "beyond its limit`. `{number}` is replaced by the raw value. Other raw values are legal "
        "too; for a closed list use an enum. Descriptions and error messages show them. Only for "
        "an integer without a scale.",
    )
    source = facts.source()
    disputed = facts.disputed()
    EXAMPLE = "{wire: word, scale: 1/100, unit: degree, range: [-180, 180], doc: An angle.}"


class Flag(Record):
    """Yes or no, encoded as 1 or 0."""

    wire = required(_WIRE, "How the raw value is encoded.")
    doc = required(Text(), _DOC)
    EXAMPLE = "{wire: byte, doc: Yes or no.}"


class Member(Record):
    """One value of an enum."""

    HEADING = "Enum member"
    value = required(Whole(), "The raw value.")
    doc = required(Text(), "What the value stands for.")
    falsy = optional(
        YesNo(), "Whether Python counts the value as false in a condition, as it does 0.", False
    )
    EXAMPLE = "{value: 1, doc: On and off in turn.}"


class Enum(Record):
    """A closed list of values, each with a name."""

    class_ = required(Name(CLASS), _CLASS)
    wire = required(_WIRE, "How the raw value is encoded.")
    doc = required(Text(), _DOC)
    members = required(
        Named(Member, UPPER, ("empty-enum", "list its values")), "The values by name."
    )
    source = facts.source()
    EXAMPLE = """\
class: Mode
wire: byte
doc: How the lamp shines.
members:
  STEADY: {value: 0, doc: Without a break.}
  BLINK: {value: 1, doc: On and off in turn.}
"""


class Value(Record):
    """Several quantities that belong together; the generated Python has a named tuple for them."""

    HEADING = "Value type"
    class_ = required(Name(CLASS), _CLASS)
    doc = required(Text(), _DOC)
    items = required(
        Named(_QUANTITY, LOWER, ("empty-value", "list its parts")),
        "The parts by name, in the order on the wire.",
    )
    EXAMPLE = "{class: Pair, doc: Two temperatures., items: {inner: warmth, outer: warmth}}"


class BitPart(Record):
    """Some bits of a word: a flag if it is one bit, else a number or the value of an enum."""

    HEADING = "Part of a word"
    bits = required(Span(), "Which bits: 3, or [4, 7]; 0 is the lowest bit.")
    doc = required(Text(), _DOC)
    enum = optional(Text(), "The enum that names the values of the bits.", "")
    signed = optional(YesNo(), "Whether the number is in two's complement.", False)
    EXAMPLE = "{bits: [4, 7], doc: How strong the signal is.}"


class Bits(Record):
    """A word divided into named bits; the generated Python has a named tuple for it.

    Bits that no part names are 0 in requests, and are not read.
    """

    class_ = required(Name(CLASS), _CLASS)
    wire = required(_WIRE, "How the word is encoded: an unsigned integer.")
    doc = required(Text(), _DOC)
    parts = required(Named(BitPart, LOWER, ("empty-value", "list its parts")), "The parts by name.")
    EXAMPLE = """\
class: Status
wire: byte
doc: How the sensor is.
parts:
  ready: {bits: 0, doc: Whether it is ready.}
  level: {bits: [4, 7], doc: How strong the signal is.}
"""


class Octets(Record):
    """Bytes without a meaning of their own."""

    HEADING = "Bytes"
    size = required(Span(), "How many: 8, or [0, 32] if the number varies.")
    doc = required(Text(), _DOC)
    EXAMPLE = "{size: [0, 32], doc: What the sensor stores.}"


class Chars(Record):
    """Text inside a frame."""

    HEADING = "Text"
    size = required(Span(), "How many bytes: 8, or [0, 32] if the number varies.")
    doc = required(Text(), _DOC)
    encoding = optional(Word(("ascii", "utf-8", "latin-1")), "How it is encoded.", "ascii")
    padding = optional(
        Whole(0, 255, "bad-size"),
        "The byte after a text that is shorter than its fixed size. Left out: each text has "
        "exactly that size.",
        -1,
    )
    EXAMPLE = "{size: 16, padding: 0, doc: The name of the sensor.}"


class Listed(Record):
    """Several elements of one type. A list of a value type repeats a group of numbers."""

    HEADING = "List"
    of = required(Text(), "A quantity, flag, enum, value type, or text of a fixed size.")
    size = required(Span(), "How many elements: 6, or [0, 8] if the number varies.")
    doc = required(Text(), _DOC)
    EXAMPLE = "{of: warmth, size: [0, 8], doc: The temperature of each sensor.}"


class TypesFile(Record):
    """The types of fields. A field names a quantity, a flag, an enum or a value type."""

    wire = optional(Named(Wire, LOWER), "How raw values are encoded.")
    quantities = optional(Named(Quantity, LOWER), "Numbers with a scale, a unit and a range.")
    flags = optional(Named(Flag, LOWER), "Yes or no, encoded as 1 or 0.")
    enums = optional(Named(Enum, LOWER), "Closed lists of values.")
    values = optional(Named(Value, LOWER), "Named tuples of quantities.")
    bits = optional(Named(Bits, LOWER), "Words divided into named bits.")
    bytes = optional(Named(Octets, LOWER), "Bytes without a meaning of their own.")
    texts = optional(Named(Chars, LOWER), "Text inside a frame.")
    lists = optional(Named(Listed, LOWER), "Several elements of one type.")


# The sections of a types file, with the record of their entries.
SECTIONS: dict[str, type[Record]] = {
    "wire": Wire,
    "quantities": Quantity,
    "flags": Flag,
    "enums": Enum,
    "values": Value,
    "bits": Bits,
    "bytes": Octets,
    "texts": Chars,
    "lists": Listed,
}
