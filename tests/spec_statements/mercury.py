"""States what numbers mean on a Mercury and its relatives, from sources that the edition lacks.

The maker's page on the Mercury X1 is elephantrobotics/Mercury_X1_docs, commit 68d457d5, file
6-SDKDevelopment/6.4-Communication.md; the edition follows the page on the A1. What that page leaves
out is in the descriptions of the class Mercury of the maker's library 4.0.7.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from cobotwire_codegen.model import Edition, Enum, Quantity
from spec_statements.effects import in_words

BASE = "mercury_a1"
# The numbers that the page explains, by type.
EXPLAINED = {"ack_status": [0, 1], "start_status": [0, 1, 2]}
# The members of enumerations. "arc", "fifo_content" and "fresh_mode" are from the library.
MEMBERS = {
    "arc": "USUAL=0 MAJOR=1 MINOR=2",
    "control_mode": "POSITION=0 TORQUE=1",
    "direction": "BACKWARD=0 FORWARD=1",
    "end_type": "FLANGE=0 TOOL=1",
    "error_kind": "JOINT_SEND=1 JOINT_READ=2 END_SEND=3 END_READ=4",
    "fifo_content": "EMPTY=0 FILLED=1",
    "fresh_mode": "QUEUE=0 NEWEST=1",
    "fusion_parameter": "JOINT_SPEED=1 JOINT_ACCELERATION=2 END_SPEED=3 END_ACCELERATION=4",
    "gripper_mode": "TRANSPARENT=0 PINS=1",
    "gripper_state": "OPEN=0 CLOSE=1",
    "limit_check": "POSITION=1 MOTION_END=2",
    "planned": "ANGLES=0 COORDS=1",
    "reference_frame": "BASE=0 WORLD=1",
    "rotation_axis": "RX=1 RY=2 RZ=3",
}
# The lowest and the highest number. The library numbers dynamic parameters, fingers and the
# registers of grippers (ProGripper, FingerGripper); its requests for a whole hand have 0 as the
# finger. Its radius goes to 655.5 mm, more than a word of hundredths can hold.
ENDS: dict[str, tuple[Fraction | int, Fraction | int]] = {
    "joint_flag": (0, 1),
    "dynamic_parameter": (0, 62),
    "finger": (1, 6),
    "finger_or_none": (0, 6),
    "tool_register": (1, 53),
    "radius": (0, Fraction(0xFFFF, 100)),
}
# The page gives these numbers to the joints of a seven-joint arm; 254 means all joints. The
# relatives with six joints have no joint 13.
RESTORED = {6: [*range(1, 7), 254], 7: [*range(1, 8), 13, 254]}
# The page: FF 01 accepts a request, and 1 reports that the arm has started. The library: a power-on
# with the mode 0 does not enable the motors.
MARK, ACCEPTED = 255, (1,)
POWER_ON = "by mode: 0 sets powered=True held=False; 1 sets powered=True held=True"


def _is_relative(edition: Edition) -> bool:
    return BASE in (edition.name, *edition.bases)


def numbers(edition: Edition) -> Iterator[str]:
    """Report types with other explained numbers, members or ends."""
    for type in edition.types if _is_relative(edition) else ():
        if isinstance(type, Quantity):
            explained = [n for low, high, _ in type.meanings for n in range(low, high + 1)]
            if type.name in EXPLAINED and explained != EXPLAINED[type.name]:
                yield f"{type.name} explains {explained}; the page {EXPLAINED[type.name]}"
            ends = tuple(Fraction(end) for end in ENDS.get(type.name, ()))
            if ends and type.range != ends:
                yield f"{type.name} goes from {type.range}; the maker says {ENDS[type.name]}"
            if type.name == "restored_joint" and [*type.choices] != RESTORED[edition.joints]:
                yield f"{type.name} has the joints {type.choices}"
        if isinstance(type, Enum):
            members = " ".join(f"{each.name}={each.value}" for each in type.members)
            if members != MEMBERS.get(type.name, members):
                yield f"{type.name} has {members}; the maker says {MEMBERS[type.name]}"


def acknowledgements(edition: Edition) -> Iterator[str]:
    """Report acknowledgements without the mark FF, or with another status for success."""
    for command in edition.commands if _is_relative(edition) else ():
        if command.ack and [variant[0].const for variant in command.replies] != [MARK]:
            yield f"the acknowledgement of {command.name} does not begin with {MARK}"
        if (command.ack or command.name == "power_on") and command.accepted != ACCEPTED:
            yield f"{command.name} accepts {command.accepted}; the page {ACCEPTED}"
        if command.name == "power_on":
            effect = "" if command.effect is None else in_words(command.effect)
            if effect != POWER_ON:
                yield f"{command.name} {effect}; the library: {POWER_ON}"


RULES = (numbers, acknowledgements)
