"""The checked protocol: frozen records without behaviour beyond what follows from their fields.

Everything knows its place, so that a rule that fails can say where.
"""

from cobotwire_codegen.model.commands import (
    Command,
    Family,
    Field,
    Form,
    ReadBack,
    Text,
    Tries,
)
from cobotwire_codegen.model.edition import Edition, Erratum, Frame, Vector
from cobotwire_codegen.model.facts import Change, Dispute, Evidence, Lines
from cobotwire_codegen.model.types import Enum, Flag, Member, Quantity, Type, Value, Wire
from cobotwire_codegen.model.words import (
    CHECKS,
    CONFIDENCE,
    ERRATUM_KINDS,
    REASONS,
    ROLES,
    SAFETY,
    UNITS,
    VERDICTS,
)

__all__ = [
    "CHECKS",
    "CONFIDENCE",
    "ERRATUM_KINDS",
    "REASONS",
    "ROLES",
    "SAFETY",
    "UNITS",
    "VERDICTS",
    "Change",
    "Command",
    "Dispute",
    "Edition",
    "Enum",
    "Erratum",
    "Evidence",
    "Family",
    "Field",
    "Flag",
    "Form",
    "Frame",
    "Lines",
    "Member",
    "Quantity",
    "ReadBack",
    "Text",
    "Tries",
    "Type",
    "Value",
    "Vector",
    "Wire",
]
