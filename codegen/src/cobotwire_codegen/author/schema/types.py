"""The types file."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire_codegen.author.schema.leaves import (
    CLASS,
    UPPER,
    Schema,
    closed,
    exact,
    free,
    lines,
    listed,
    name,
    named,
    one_of,
    range_of,
    ref,
    text,
    whole,
)
from cobotwire_codegen.build.parts import SECTIONS
from cobotwire_codegen.model import CONFIDENCE, UNITS

_SECTION_DOCS = {
    "wire": "How whole numbers stand on the wire.",
    "quantities": "Numbers with a scale, a unit and a range.",
    "flags": "Yes or no, as 1 or 0.",
    "enums": "Closed lists of values.",
    "values": "Named tuples of quantities.",
}
SOURCE = ref("source")
_ONE = {"wire": "wire", "quantities": "quantity", "flags": "flag", "enums": "enum"}


def known(names: Sequence[str], doc: str, docs: Sequence[str] = ()) -> Schema:
    """The name of a type: of the edition's where they are known, else any."""
    return one_of(names, doc, docs) if names else name(doc)


def type_definitions(wires: Sequence[str], quantities: Sequence[str]) -> dict[str, Schema]:
    """Every kind of type, and the file that holds them."""
    sections = {
        section: named(ref(_ONE.get(section, "value")), _SECTION_DOCS[section])
        for section in SECTIONS
    }
    wire = ref("wire_name")
    doc = text("What it is, in a sentence.")
    return {
        "types_file": closed("What a field can be, said once.", {}, sections),
        "wire": _wire(doc),
        "quantity": _quantity(wire, doc),
        "flag": closed("Yes or no, as 1 or 0.", {"wire": wire, "doc": doc}),
        "enum": _enum(wire, doc),
        "member": closed(
            "One value of an enum.",
            {"value": whole("The number on the wire."), "doc": text("What it stands for.")},
        ),
        "value": _value(ref("quantity_name"), doc),
        "wire_name": known(wires, "The wire type: its bytes, their order, the sign."),
        "quantity_name": known(quantities, "A quantity."),
        "source": lines("Lines of the document that say so: 12, 20-39, or a list of these."),
        "disputed": listed(ref("dispute"), "Facts that the sources do not agree on."),
        "dispute": _dispute(),
        "evidence": _evidence(),
    }


def _wire(doc: Schema) -> Schema:
    signed_at = "Raw words above it stand for raw - 256^bytes: 32767 is two's complement. Left "
    return closed(
        "How a whole number stands on the wire.",
        {"bytes": whole("Its width in bytes.", 1, 4), "doc": doc},
        {
            "order": one_of(("big", "little"), "Which byte comes first. Left out: big."),
            "signed_at": whole(signed_at + "out: nothing is negative.", 0),
            "source": SOURCE,
            "disputed": ref("disputed"),
        },
    )


def _quantity(wire: Schema, doc: Schema) -> Schema:
    choices = listed(whole("A number on the wire."), "The legal numbers on the wire, all of them.")
    return closed(
        "A number with a scale, a unit and a range.",
        {"wire": wire, "doc": doc},
        {
            "scale": exact("Value = number on the wire x scale: 1/100, 0.01 or 3. Left out: 1."),
            "unit": one_of(UNITS, "The unit. Left out: none."),
            "range": range_of("Lowest and highest value, in the unit. Left out: all of the wire."),
            "choices": choices,
            "shown_in": one_of(("radian",), "The API speaks radians, the wire degrees."),
            "source": SOURCE,
            "disputed": ref("disputed"),
        },
    )


def _enum(wire: Schema, doc: Schema) -> Schema:
    return closed(
        "A closed list of values.",
        {
            "class": name("The class in the generated Python.", CLASS),
            "wire": wire,
            "doc": doc,
            "members": {**named(ref("member"), "Its values.", UPPER), "minProperties": 1},
        },
        {"source": SOURCE},
    )


def _value(quantity: Schema, doc: Schema) -> Schema:
    return closed(
        "Several quantities that belong together: a named tuple.",
        {
            "class": name("The class in the generated Python.", CLASS),
            "doc": doc,
            "items": {**named(quantity, "Its parts, in wire order."), "minProperties": 1},
        },
    )


def _dispute() -> Schema:
    return closed(
        "A fact that the sources do not agree on.",
        {
            "claim": text("The fact, as it is read here."),
            "reading": text("The same as a formula or in few words."),
            "confidence": one_of(CONFIDENCE, "How sure the reading is."),
            "evidence": listed(ref("evidence"), "Who says what.", 1),
        },
    )


def _evidence() -> Schema:
    return closed(
        "One source's word.",
        {"source": text("Who says it."), "says": text("What it says.")},
        {"lines": lines("Where it says it.")},
    )


def free_doc() -> Schema:
    """A sentence that may be left out."""
    return free("What it is. Left out: what its type is.")
