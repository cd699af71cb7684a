"""Diagnose noise: servo packets, firmware text, reboots, echoes, damaged frames.

:class:`Diagnoser` takes the events of a framer, and returns frames and findings. It does no I/O.
"""

from cobotwire.diagnose.diagnoser import Diagnoser, Item
from cobotwire.diagnose.findings import (
    Boot,
    CommandError,
    DamagedFrame,
    Finding,
    Garbage,
    Nuls,
    OppositeFrame,
    Panic,
    ServoPacket,
    Span,
    Text,
    UnlistedFrame,
    Unrecognised,
)
from cobotwire.diagnose.summary import Summary, summarize

__all__ = [
    "Boot",
    "CommandError",
    "DamagedFrame",
    "Diagnoser",
    "Finding",
    "Garbage",
    "Item",
    "Nuls",
    "OppositeFrame",
    "Panic",
    "ServoPacket",
    "Span",
    "Summary",
    "Text",
    "UnlistedFrame",
    "Unrecognised",
    "summarize",
]
