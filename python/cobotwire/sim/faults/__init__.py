"""Bad lines on demand: scenarios of faults, from YAML files or as objects.

    scenario = Scenario(name="sick", faults=(Lost(probability=0.25), ServoLeak(every=3)))
    peer = scenario.wrap(SimulatedArm(TABLE), codec)

The language of the files is in ``docs/simulation.md``.
"""

from cobotwire.sim.faults.derived import derived
from cobotwire.sim.faults.exchange import Done
from cobotwire.sim.faults.fault import Fault
from cobotwire.sim.faults.faulty import FaultyPeer
from cobotwire.sim.faults.kinds import KINDS
from cobotwire.sim.faults.kinds.additions import CommandError, Doubled, Echo, Inserted, ServoLeak
from cobotwire.sim.faults.kinds.controller import Panic
from cobotwire.sim.faults.kinds.damage import Corrupted, Replaced, WrongId, WrongLength
from cobotwire.sim.faults.kinds.loss import Dropped, Frozen, Lost, Silent, Truncated
from cobotwire.sim.faults.kinds.timing import Late, Merged, Slow, Split, Stalled
from cobotwire.sim.faults.kinds.wiring import FlowControl, Unplugged, WrongBaud
from cobotwire.sim.faults.reader import load, loads
from cobotwire.sim.faults.scenario import Scenario
from cobotwire.sim.faults.shipped import find, shipped

__all__ = [
    "KINDS",
    "CommandError",
    "Corrupted",
    "Done",
    "Doubled",
    "Dropped",
    "Echo",
    "Fault",
    "FaultyPeer",
    "FlowControl",
    "Frozen",
    "Inserted",
    "Late",
    "Lost",
    "Merged",
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
    "WrongBaud",
    "WrongId",
    "WrongLength",
    "derived",
    "find",
    "load",
    "loads",
    "shipped",
]
