"""The protocol as frozen records; their methods only derive facts from their fields.

Every record knows its place in the spec, so that problems can name it.
"""

from cobotwire_codegen.model.commands import (
    Command,
    Family,
    Field,
    ReadBack,
    Samples,
    Text,
    Variant,
    named_fields,
)
from cobotwire_codegen.model.edition import (
    Derivation,
    Edition,
    Erratum,
    Limits,
    Vector,
)
from cobotwire_codegen.model.effects import Effect, State
from cobotwire_codegen.model.facts import (
    Change,
    Dispute,
    Evidence,
    Firmware,
    Lines,
    Observation,
    ObservedFact,
)
from cobotwire_codegen.model.frame import Address, Frame, FrameCheck, FrameNumber
from cobotwire_codegen.model.robot import (
    Encoders,
    ErrorCodes,
    Geometry,
    Gripper,
    Link,
    Motion,
    Robot,
    Servos,
)
from cobotwire_codegen.model.shapes import BitPart, Bits, Chars, Listed, Octets, Type
from cobotwire_codegen.model.types import (
    Enum,
    Flag,
    Member,
    Quantity,
    Scalar,
    Value,
)
from cobotwire_codegen.model.wires import Wire

__all__ = [
    "Address",
    "BitPart",
    "Bits",
    "Change",
    "Chars",
    "Command",
    "Derivation",
    "Dispute",
    "Edition",
    "Effect",
    "Encoders",
    "Enum",
    "Erratum",
    "ErrorCodes",
    "Evidence",
    "Family",
    "Field",
    "Firmware",
    "Flag",
    "Frame",
    "FrameCheck",
    "FrameNumber",
    "Geometry",
    "Gripper",
    "Limits",
    "Lines",
    "Link",
    "Listed",
    "Member",
    "Motion",
    "Observation",
    "ObservedFact",
    "Octets",
    "Quantity",
    "ReadBack",
    "Robot",
    "Samples",
    "Scalar",
    "Servos",
    "State",
    "Text",
    "Type",
    "Value",
    "Variant",
    "Vector",
    "Wire",
    "named_fields",
]
