"""The types file: the types of fields."""

from __future__ import annotations

from cobotwire_codegen.language import facts
from cobotwire_codegen.language.meanings import MeaningsOfNumbers
from cobotwire_codegen.language.names import CLASS, LOWER, UPPER
from cobotwire_codegen.language.records import Named, Record, optional, required
from cobotwire_codegen.language.shapes import (
    Exact,
    Known,
    Name,
    Numbers,
    Range,
    Text,
    Whole,
    Word,
    YesNo,
)
from cobotwire_codegen.language.units import UNITS

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
        Word(
            ("integer", "float"),
            ("A whole number.", "An IEEE 754 float of 4 or 8 bytes; it has no sign rule."),
        ),
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


class TypesFile(Record):
    """The types of fields. A field names a quantity, a flag, an enum or a value type."""

    wire = optional(Named(Wire, LOWER), "How raw values are encoded.")
    quantities = optional(Named(Quantity, LOWER), "Numbers with a scale, a unit and a range.")
    flags = optional(Named(Flag, LOWER), "Yes or no, encoded as 1 or 0.")
    enums = optional(Named(Enum, LOWER), "Closed lists of values.")
    values = optional(Named(Value, LOWER), "Named tuples of quantities.")


# The sections of a types file, with the record of their entries.
SECTIONS: dict[str, type[Record]] = {
    "wire": Wire,
    "quantities": Quantity,
    "flags": Flag,
    "enums": Enum,
    "values": Value,
}
