"""What the arm does for each command: registered by the type of its request.

The behaviours of families (``registry.HOMES``) are imported when an arm of the family needs them.
"""

from cobotwire.simulator.behaviour import (  # noqa: F401  (importing them registers them)
    drag,
    gripper,
    io,
    jog,
    motion,
    planning,
    power,
    servo,
    system,
    upkeep,
)
from cobotwire.simulator.behaviour.registry import (
    BEHAVIOURS,
    Behaviour,
    Behaviours,
    Sized,
    behaviour,
    own,
)

__all__ = ["BEHAVIOURS", "Behaviour", "Behaviours", "Sized", "behaviour", "own"]
