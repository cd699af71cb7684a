"""Connect one of pymycobot's classes to a simulated arm through a real pty."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from cobotwire.codec.interface import Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.table import Table
from cobotwire.session import RequestReceived, TextReceived
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.simulator.state import ArmState

# A joint stops on an encoder tick, so it is off by up to half a tick. Read back, an angle is also
# truncated to hundredths.
HALF_TICK, READ_BACK = 0.044, 0.054
# A bent pose, from which the end can move in every direction.
BENT = (10.01953125, -30.05859375, -60.029296875, 20.0390625, 5.009765625, 30.05859375)


def on_ticks(*angles: float) -> Any:
    """Match the angles of joints that were sent to ``angles`` and stopped on the nearest ticks."""
    return pytest.approx(angles, abs=HALF_TICK)


class Rig:
    """The library, the arm that it drives, and what that arm received.

    The test advances the arm's clock, so no test depends on the speed of this machine. Only the
    library's own waiting takes real time.
    """

    peer: Any

    def __init__(self, table: Table) -> None:
        self.now = 0.0
        self.received: list[str] = []
        self.rejected: list[bytes] = []
        self.texts: list[tuple[str, dict[str, str]]] = []
        self.arm = SimulatedArm(table, clock=lambda: self.now, on_event=self._record)

    @property
    def state(self) -> ArmState:
        """Return the state of the arm."""
        return self.arm.state

    @property
    def angles(self) -> tuple[float, ...]:
        """Return the joint angles, each on an encoder tick."""
        return self.state.standing(self.now)

    @property
    def pose(self) -> tuple[float, ...]:
        """Return the coordinates of the end as the arm reports them."""
        coords = self.state.reported_coords(self.state.standing(self.now))
        assert coords is not None
        return coords

    def start_over(self) -> None:
        """Reset the arm and power it; powering it by pymycobot would take 1.5 s in each test."""
        self.arm.state = self.arm.new_state()
        self.state.powered = True
        self.state.enabled = [True] * self.arm.table.joints
        self.received.clear()
        self.rejected.clear()
        self.texts.clear()

    def bend(self) -> None:
        """Put the arm into the bent pose."""
        self.state.angles.place(BENT, self.now)

    def settle(self) -> None:
        """Wait until the arm has handled every request; it handles them in order."""
        self.peer.is_controller_connected()
        self.received.remove("is_controller_connected")

    def advance(self, seconds: float) -> None:
        """Advance the arm's clock. Multiples of a quarter second keep its arithmetic exact."""
        self.now += seconds

    def _record(self, event: DeviceEvent, reply: bytes) -> None:
        if isinstance(event, RequestReceived):
            self.received.append(event.message.command.name)
        elif isinstance(event, TextReceived):
            self.texts.append((event.command.name, event.fields))
        else:
            self.rejected.append(event.data if isinstance(event, Noise) else event.frame.data)


@contextmanager
def driven_by(kind: type[Any], table: Table = TABLE) -> Iterator[Rig]:
    """Open a port with one of pymycobot's classes; two of them sleep 1.5 s while they open it."""
    rig = Rig(table)
    with PtyServer(rig.arm) as server:
        rig.peer = kind(server.url)
        try:
            yield rig
        finally:
            rig.peer.close()


def rig_fixtures(kind: type[Any], table: Table = TABLE, *, connection: str) -> tuple[Any, Any]:
    """Return two fixtures: the connection of a module, and its rig, reset for each test.

    A module opens each class once, since the constructors of two classes sleep 1.5 s.
    """

    @pytest.fixture(scope="module", name=connection)
    def opened() -> Iterator[Rig]:
        with driven_by(kind, table) as rig:
            yield rig

    @pytest.fixture
    def rig(request: pytest.FixtureRequest) -> Rig:
        found: Rig = request.getfixturevalue(connection)
        found.start_over()
        return found

    return opened, rig
