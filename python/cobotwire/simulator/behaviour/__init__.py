"""Commands that the simulator implements in code: physics, and features of single robots.

The behaviours of families (``registry.HOMES``) are imported when an arm of the family needs them.
"""

from cobotwire.simulator.behaviour import drag, servo  # noqa: F401  (importing registers them)
from cobotwire.simulator.behaviour.registry import (
    BEHAVIOURS,
    Behaviour,
    Behaviours,
    Sized,
    behaviour,
    own,
)

__all__ = ["BEHAVIOURS", "Behaviour", "Behaviours", "Sized", "behaviour", "own"]
