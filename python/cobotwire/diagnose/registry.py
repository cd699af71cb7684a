"""List the classes of noise and their recognisers: the only place that names them all."""

from __future__ import annotations

from cobotwire.diagnose.damaged import DamagedFrame, DamagedFrames
from cobotwire.diagnose.findings import Finding
from cobotwire.diagnose.firmware import Boot, CommandError, Firmware, Text
from cobotwire.diagnose.frames import Frames, OppositeFrame, UnlistedFrame
from cobotwire.diagnose.garbage import Garbage, Unrecognised
from cobotwire.diagnose.nuls import NulRuns, Nuls
from cobotwire.diagnose.panic import Panic
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.servo import ServoBus, ServoPacket

# The classes, the most important first: summaries and advice list them in this order.
CLASSES: tuple[type[Finding], ...] = (
    Panic,
    Boot,
    Nuls,
    CommandError,
    Garbage,
    DamagedFrame,
    UnlistedFrame,
    OppositeFrame,
    ServoPacket,
    Text,
    Unrecognised,
)

# They are called in this order. The first one that finds something, or needs more bytes, decides.
# ``garbage.classify`` handles the bytes in which none of them finds anything.
RECOGNISERS: tuple[type[Recogniser], ...] = (Frames, DamagedFrames, ServoBus, NulRuns, Firmware)

__all__ = [
    "CLASSES",
    "Boot",
    "CommandError",
    "DamagedFrame",
    "Garbage",
    "Nuls",
    "OppositeFrame",
    "Panic",
    "ServoPacket",
    "Text",
    "UnlistedFrame",
    "Unrecognised",
]
