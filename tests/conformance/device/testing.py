"""Run the tester on a peer in memory, in stepped time."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

from cobotwire.conformance import Result
from cobotwire.conformance.device import ALL_PERMISSIONS, DeviceConnection, Permissions, Tester
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.simulator.peer import Peer

Wrap = Callable[[SimulatedArm], Peer]


def permissions(*classes: str, joints: int = 6, max_speed: int = 60) -> Permissions:
    """Return permissions, with a small workspace if motion is among them."""
    space = {joint: (-60.0, 60.0) for joint in range(1, joints + 1)}
    return Permissions.of(classes, joints=joints, max_speed=max_speed, workspace=space)


def on_peer(
    peer: Peer, clock: SteppedClock, table: Table, tester: type[Tester] = Tester, **options: Any
) -> Tester:
    """Return a tester of a peer; both use ``clock``. By default it has all permissions."""
    options.setdefault("permissions", permissions(*ALL_PERMISSIONS, joints=table.joints))
    line = DeviceConnection(MemoryTransport(peer, clock), clock)
    return tester(line, table, **options)


def prepared(
    table: Table, wrap: Wrap = lambda arm: arm, *, device: Table | None = None, **options: Any
) -> Tester:
    """Return a tester for an edition, on a wrapped arm of that edition or of ``device``."""
    clock = SteppedClock()
    return on_peer(wrap(SimulatedArm(device or table, clock=clock)), clock, table, **options)


def results_of(tester: Tester, *commands: str) -> list[Result]:
    """Run only the steps of some commands; an empty name selects the steps without a command."""
    return [
        result
        for step in tester.steps()
        if (step.command.name if step.command else "") in commands
        for result in tester.results(step)
    ]


class Altered:
    """A peer that replies with ``alter(request, reply, number of the request)``."""

    def __init__(self, peer: Peer, alter: Callable[[bytes, bytes, int], bytes]) -> None:
        self._peer = peer
        self._alter = alter
        self._count = 0

    @property
    def wait(self) -> float | None:
        return self._peer.wait

    def receive(self, data: bytes) -> bytes:
        self._count += 1
        return self._alter(data, self._peer.receive(data), self._count)

    def flush(self) -> bytes:
        return self._peer.flush()


def altering(table: Table, command: str, change: Callable[[bytes], bytes]) -> Wrap:
    """Return a function that wraps an arm and changes its replies to one command."""
    at, id = table.frame.id_at, table.command(command).id

    def alter(request: bytes, reply: bytes, count: int) -> bytes:
        return change(reply) if reply and request[at : at + 1] == bytes([id]) else reply

    return lambda arm: Altered(arm, alter)


# An interrupted run does not restore the power, since an arm without power would fall.
HELD = ("powered",)
# State that is not a setting: the arm's position, history and build.
NOT_SET = ("angles", "gripper", "enabled", "connected", "error", "remarks", "geometry", "record_at")
# The colour of the light, which no query reports.
NOT_REPORTED = ("red", "green", "blue")


def settings_of(arm: SimulatedArm, *, but: tuple[str, ...] = ()) -> dict[str, object]:
    """Return a copy of everything that can be set, except ``but``, by name."""
    state = {name: v for name, v in vars(arm.state).items() if name not in (*NOT_SET, *but)}
    kept = {name: v for name, v in arm.state.kept.items() if name not in NOT_REPORTED}
    # A low pin is equivalent to a pin that was never set.
    state["kept"] = {
        name: {index: v for index, v in value.items() if v} if isinstance(value, dict) else value
        for name, value in kept.items()
    }
    return deepcopy(state)
