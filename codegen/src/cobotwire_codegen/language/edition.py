"""The edition file, and which files it consists of."""

from __future__ import annotations

from cobotwire_codegen.language.changes import CHANGE, ChangesFile
from cobotwire_codegen.language.effects import State
from cobotwire_codegen.language.evidence import EvidenceFile
from cobotwire_codegen.language.frame import FrameFile
from cobotwire_codegen.language.json_schema import ref
from cobotwire_codegen.language.messages import Command, CommandsFile, ReplyField, accepted_key
from cobotwire_codegen.language.names import BASE, CLASS, LOWER, METHOD
from cobotwire_codegen.language.number_shapes import Ranges, Reals, Whole
from cobotwire_codegen.language.proof import VECTOR, ErrataFile, Erratum, VectorsFile
from cobotwire_codegen.language.records import (
    Choice,
    Described,
    InFile,
    InFiles,
    Listed,
    Named,
    Part,
    Record,
    optional,
    or_file,
    required,
)
from cobotwire_codegen.language.robot import (
    Encoders,
    ErrorCodes,
    Geometry,
    Gripper,
    Motion,
    Servos,
)
from cobotwire_codegen.language.shapes import Name, Names, Text
from cobotwire_codegen.language.types import SECTIONS, TypesFile

_JOINTS = "How many joints the arm has."
_FRAME = "The frame format and the transport."
_INHERITED = "A delta inherits it if it has as many joints as its base."


class Acks(Record):
    """The acknowledgement of every command that has no other reply."""

    field = optional(
        Part(ReplyField), "The field of the reply; a frame without data is legal as well."
    )
    fields = optional(
        Listed(ReplyField),
        "The fields of the reply, if it has several; a frame without data is then not legal.",
    )
    accepted = accepted_key()
    why = required(Text(), "The reason.")
    except_ = optional(Names(), "Commands that are not acknowledged.")
    EXCLUSIVE = (("field", "fields"),)
    EXAMPLE = """\
field: {name: done, type: flag}
except: [set_ssid_pwd]
why: Closed-loop firmware acknowledges setters; older firmware sends nothing.
"""


_CHANGES = Choice("changes_or_change", {"changes": ChangesFile}, CHANGE)
_VECTORS = Choice("vectors_or_vector", {"vectors": VectorsFile}, VECTOR)
_ERRATA = Choice("errata_or_erratum", {"errata": ErrataFile}, Erratum)


class _Edition(Record):
    edition = required(Name(LOWER), "The edition's name; the name of the generated package.")
    class_ = required(Name(CLASS), "The client's class in the generated Python.")
    title = required(Text(), "A heading.")
    doc = required(Text(), "What the edition is, in a sentence or two.")
    document = optional(Text(), "The document that describes the edition.")
    firmware = optional(Text(), "The firmware that uses the edition.")
    types = optional(InFile(TypesFile), "The types of fields.")
    commands = optional(
        InFiles(CommandsFile, Named(Command, METHOD)),
        "The commands: a file for each family, or a mapping of all commands as one family.",
    )
    vectors = optional(
        InFiles(_VECTORS, or_file(ref(VectorsFile.definition()))),
        "Frames with the values that they carry. Every variant of every message needs one.",
    )
    errata = optional(
        InFiles(_ERRATA, or_file(ref(ErrataFile.definition()))),
        "The places where the document is wrong or contradicts itself.",
    )
    evidence = optional(
        InFiles(EvidenceFile),
        "What real arms showed: a file for each run. `cobotwire-gen evidence add` adds them.",
    )
    motion = optional(
        Part(Motion),
        f"How the arm moves. {_INHERITED} Left out: a simulated arm turns one degree a second for "
        "each percent of speed.",
    )
    acks = optional(
        Part(Acks),
        "How commands without a reply are acknowledged. In a delta they replace the rules of its "
        "base; the change `withdraw_acks` removes the rules of the base.",
    )
    geometry = optional(
        Part(Geometry),
        f"The arm's geometry. {_INHERITED}",
    )
    geometry_unknown = optional(
        Text(),
        "Why the geometry is not known. A delta with this key does not inherit the geometry of its "
        "base: its simulated arm sends no coordinates instead of wrong ones. The key has no effect "
        "beside `geometry`.",
    )
    encoders = optional(
        Part(Encoders),
        f"How the encoders of the joints count. {_INHERITED} Left out: a simulated arm does not "
        "round joint angles to encoder ticks.",
    )
    gripper = optional(Part(Gripper), "The gripper. A delta inherits that of its base.")
    servos = optional(Part(Servos), "What the servos report. A delta inherits it from its base.")
    error_codes = optional(
        Part(ErrorCodes),
        f"The error codes that the arm reports when it rejects a motion. {_INHERITED} Left out: a "
        "simulated arm reports no error.",
    )
    joint_limits = optional(
        Ranges(),
        f"For each joint, the lowest and the highest angle that the arm obeys. {_INHERITED} They "
        "have no effect if the types of joint targets already have a range.",
    )
    start_angles = optional(
        Reals(),
        f"The joint angles at which a simulated arm starts. {_INHERITED} Left out: 0 degrees.",
    )
    state = optional(
        Named(State, LOWER),
        "The values that the arm keeps, by name. A delta inherits the state of its base, and can "
        "replace single keys of it.",
    )


class WholeEdition(_Edition):
    """An edition: one version of a protocol."""

    HEADING = "Edition"
    joints = required(Whole(0), _JOINTS)
    frame = required(InFile(FrameFile), _FRAME)


class DeltaEdition(_Edition):
    """An edition that is stated as the difference from another one, its base.

    It inherits the frame, types, commands and vectors of its base, changes them as `changes` lists,
    and adds types, commands and vectors of its own. If only the frame format, ranges or the number
    of joints changed, the inherited vectors are derived again: a value outside its new range
    becomes the nearest legal one. Published vectors state what they were derived from.
    """

    base = required(
        Name(BASE, "a file name, or PACKAGE:EDITION"),
        "The file of the base, or an edition that an installed package ships: "
        "`cobotwire:mycobot280`.",
    )
    joints = optional(Whole(0), f"{_JOINTS} Left out: as in the base.")
    frame = optional(InFile(FrameFile), f"{_FRAME} Left out: as in the base.")
    changes = optional(InFiles(_CHANGES), "The changes, in order.")


# The keys that describe the robot. The values of `JOINT_KEYS` fit only one number of joints.
JOINT_KEYS = ("geometry", "motion", "encoders", "error_codes", "joint_limits", "start_angles")
ROBOT_KEYS = (*JOINT_KEYS, "gripper", "servos")

EDITION = Choice("edition", {"base": DeltaEdition}, WholeEdition)

# The first of these keys that a file has decides its kind. An edition may have other keys of this
# list, so `edition` is first.
FILES: dict[str, Described] = {
    "edition": EDITION,
    "evidence": EvidenceFile,
    "family": CommandsFile,
    "changes": ChangesFile,
    "vectors": VectorsFile,
    "errata": ErrataFile,
    "frame": FrameFile,
    **dict.fromkeys(SECTIONS, TypesFile),
}
