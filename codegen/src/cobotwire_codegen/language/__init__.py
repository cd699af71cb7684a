"""The language of the spec, described once.

The reader, the JSON schema for editors and the reference page are derived from these records. A
record is a class, and its attributes are the keys: ``reader.get(language.Quantity.scale)``.
"""

from cobotwire_codegen.language.changes import (
    CHANGE,
    FIELD_CHANGES,
    AddRequestField,
    ChangeCommands,
    ChangeRequestField,
    ChangesFile,
    ChangeTypes,
    RemoveCommands,
    RemoveField,
    RenameCommand,
    RenameField,
    WithdrawVectors,
)
from cobotwire_codegen.language.edition import (
    EDITION,
    FILES,
    Acks,
    DeltaEdition,
    WholeEdition,
)
from cobotwire_codegen.language.facts import Dispute, Evidence
from cobotwire_codegen.language.frame import Address, Frame, FrameFile, Transport
from cobotwire_codegen.language.geometry import Geometry, Link, Motion
from cobotwire_codegen.language.messages import (
    FIELDS,
    Case,
    Command,
    CommandsFile,
    ReplyField,
    ReplyText,
    RequestField,
    RequestText,
    SelectedRequestField,
    TextField,
)
from cobotwire_codegen.language.proof import (
    VECTOR,
    ErrataFile,
    Erratum,
    ExampleVector,
    NamedVector,
    Rejection,
    VectorsFile,
)
from cobotwire_codegen.language.records import Choice, Key, Record
from cobotwire_codegen.language.types import (
    SECTIONS,
    Enum,
    Flag,
    Member,
    Quantity,
    TypesFile,
    Value,
    Wire,
)

__all__ = [
    "CHANGE",
    "EDITION",
    "FIELDS",
    "FIELD_CHANGES",
    "FILES",
    "SECTIONS",
    "VECTOR",
    "Acks",
    "AddRequestField",
    "Address",
    "Case",
    "ChangeCommands",
    "ChangeRequestField",
    "ChangeTypes",
    "ChangesFile",
    "Choice",
    "Command",
    "CommandsFile",
    "DeltaEdition",
    "Dispute",
    "Enum",
    "ErrataFile",
    "Erratum",
    "Evidence",
    "ExampleVector",
    "Flag",
    "Frame",
    "FrameFile",
    "Geometry",
    "Key",
    "Link",
    "Member",
    "Motion",
    "NamedVector",
    "Quantity",
    "Record",
    "Rejection",
    "RemoveCommands",
    "RemoveField",
    "RenameCommand",
    "RenameField",
    "ReplyField",
    "ReplyText",
    "RequestField",
    "RequestText",
    "SelectedRequestField",
    "TextField",
    "Transport",
    "TypesFile",
    "Value",
    "VectorsFile",
    "WholeEdition",
    "Wire",
    "WithdrawVectors",
]
