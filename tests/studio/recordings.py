"""Record a short session with a simulated arm, for the tests of the studio."""

from __future__ import annotations

from pathlib import Path

from cobotwire.editions.mycobot280 import Angles, MyCobot280
from cobotwire.editions.mycobot280.table import TABLE
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock

TARGET = Angles(80.0, -50.0, -40.0, 30.0, 20.0, 60.0)
STEP_SECONDS = 0.05


def record(path: Path, seconds: float = 6.0) -> Path:
    """Record an arm that is polled while it moves; time is stepped, so this takes no time."""
    clock = SteppedClock()
    arm = SimulatedArm(TABLE, clock=clock, powered=True)
    with MyCobot280(MemoryTransport(arm, clock), record=path) as client:
        client.send_angles(TARGET, 40)
        for _ in range(round(seconds / STEP_SECONDS)):
            client.get_angles()
            client.get_coords()
            clock.sleep(STEP_SECONDS)
    return path
