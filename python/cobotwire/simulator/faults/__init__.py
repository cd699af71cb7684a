"""Scenarios of faults on a line, from YAML files or as objects.

    scenario = Scenario(name="lossy", faults=(Lost(probability=0.25), ServoLeak(every=3)))
    peer = scenario.wrap(SimulatedArm(TABLE), codec)

``docs/simulation.md`` describes the language of the files. ``noise`` is the catalogue of noise,
``stream`` damages bytes without a session.
"""

from cobotwire.simulator.faults.derived import derived
from cobotwire.simulator.faults.exchange import AppliedFault
from cobotwire.simulator.faults.fault import Fault
from cobotwire.simulator.faults.faulty import FaultyPeer
from cobotwire.simulator.faults.kinds import KINDS
from cobotwire.simulator.faults.kinds.additions import (
    CommandError,
    Duplicated,
    Echo,
    Inserted,
    Noise,
    ServoLeak,
)
from cobotwire.simulator.faults.kinds.controller import Panic
from cobotwire.simulator.faults.kinds.damage import Corrupted, Replaced, WrongId, WrongLength
from cobotwire.simulator.faults.kinds.loss import Dropped, Frozen, Lost, Silent, Truncated
from cobotwire.simulator.faults.kinds.messages import OtherAddress, UnrequestedEvent
from cobotwire.simulator.faults.kinds.timing import Late, Merged, Slow, Split, Stalled
from cobotwire.simulator.faults.kinds.wiring import FlowControl, Unplugged, WrongBaud
from cobotwire.simulator.faults.reader import load, loads
from cobotwire.simulator.faults.scenario import Scenario
from cobotwire.simulator.faults.shipped import find, shipped

__all__ = [
    "KINDS",
    "AppliedFault",
    "CommandError",
    "Corrupted",
    "Dropped",
    "Duplicated",
    "Echo",
    "Fault",
    "FaultyPeer",
    "FlowControl",
    "Frozen",
    "Inserted",
    "Late",
    "Lost",
    "Merged",
    "Noise",
    "OtherAddress",
    "Panic",
    "Replaced",
    "Scenario",
    "ServoLeak",
    "Silent",
    "Slow",
    "Split",
    "Stalled",
    "Truncated",
    "Unplugged",
    "UnrequestedEvent",
    "WrongBaud",
    "WrongId",
    "WrongLength",
    "derived",
    "find",
    "load",
    "loads",
    "shipped",
]
