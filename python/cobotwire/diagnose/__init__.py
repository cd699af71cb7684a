"""What noise is: servo packets, the firmware's text, reboots, echoes, damaged frames.

Sans-I/O, on top of a framer: :class:`Diagnoser` takes its events and gives findings.
"""

from cobotwire.diagnose.diagnoser import Diagnoser, Item
from cobotwire.diagnose.findings import (
    Boot,
    CommandError,
    DamagedFrame,
    Finding,
    Garbage,
    Nuls,
    OtherWay,
    Panic,
    ServoPacket,
    Span,
    Text,
    UnlistedFrame,
    Unrecognised,
)
from cobotwire.diagnose.words import Summary, summary, words

__all__ = [
    "Boot",
    "CommandError",
    "DamagedFrame",
    "Diagnoser",
    "Finding",
    "Garbage",
    "Item",
    "Nuls",
    "OtherWay",
    "Panic",
    "ServoPacket",
    "Span",
    "Summary",
    "Text",
    "UnlistedFrame",
    "Unrecognised",
    "summary",
    "words",
]
