"""One of pymycobot's classes, as its users open it, on a simulated arm behind a real pty."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from cobotwire.codec.interface import Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import Asked, Told
from cobotwire.session.device import DeviceEvent
from cobotwire.sim import PtyServer, SimulatedArm
from cobotwire.sim.state import ArmState
from cobotwire.table import Table

# Half of a tick of the encoders on which joints stand; told, an angle is cut to hundredths too.
HALF_TICK, TOLD = 0.044, 0.054
# A pose that is bent, from which the end can go anywhere.
BENT = (10.01953125, -30.05859375, -60.029296875, 20.0390625, 5.009765625, 30.05859375)


def on_ticks(*angles: float) -> Any:
    """Equal to the angles at which joints stand that were sent to ``angles``."""
    return pytest.approx(angles, abs=HALF_TICK)


class Bench:
    """The library, the arm that it drives, and what that arm heard.

    The arm's clock stands until it is advanced, so that no test depends on how fast this machine
    is; only the library's own waiting takes real time.
    """

    peer: Any

    def __init__(self, table: Table) -> None:
        self.now = 0.0
        self.heard: list[str] = []
        self.refused: list[bytes] = []
        self.told: list[tuple[str, dict[str, str]]] = []
        self.arm = SimulatedArm(table, clock=lambda: self.now, watch=self._watch)

    @property
    def state(self) -> ArmState:
        """What the arm remembers."""
        return self.arm.state

    @property
    def angles(self) -> tuple[float, ...]:
        """Where the joints stand, on their ticks."""
        return self.state.standing(self.now)

    @property
    def pose(self) -> tuple[float, ...]:
        """What the arm tells of where its end stands."""
        coords = self.state.told_coords(self.state.standing(self.now))
        assert coords is not None
        return coords

    def start_over(self) -> None:
        """A new arm, powered: to have pymycobot power it would take 1.5 s in every test."""
        self.arm.state = ArmState(self.arm.table.joints, self.arm.state.geometry)
        self.state.powered = True
        self.state.enabled = [True] * self.arm.table.joints
        self.heard.clear()
        self.refused.clear()
        self.told.clear()

    def bend(self) -> None:
        """Put the arm where its end can go anywhere."""
        self.state.angles.place(BENT, self.now)

    def settle(self) -> None:
        """Wait until the arm has handled all that was sent: requests are handled in order."""
        self.peer.is_controller_connected()
        self.heard.remove("is_controller_connected")

    def advance(self, seconds: float) -> None:
        """Let time pass for the arm. Whole halves and quarters keep its arithmetic exact."""
        self.now += seconds

    def _watch(self, event: DeviceEvent, answer: bytes) -> None:
        if isinstance(event, Asked):
            self.heard.append(event.message.command.name)
        elif isinstance(event, Told):
            self.told.append((event.command.name, event.fields))
        else:
            self.refused.append(event.data if isinstance(event, Noise) else event.frame.data)


@contextmanager
def driven_by(kind: type[Any], table: Table = TABLE) -> Iterator[Bench]:
    """Open a port with one of pymycobot's classes; two of them sleep 1.5 s over it."""
    bench = Bench(table)
    with PtyServer(bench.arm) as server:
        bench.peer = kind(server.url)
        try:
            yield bench
        finally:
            bench.peer.close()
