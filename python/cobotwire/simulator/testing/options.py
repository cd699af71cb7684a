"""The arguments of the mark, which choose the simulated arm of a test."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Protocol

from cobotwire import editions
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import UsageError, did_you_mean
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import Clock
from cobotwire.simulator.faults import find
from cobotwire.simulator.peer import Peer

TRANSPORTS = ("memory", "pty", "tcp")
FASTEST = 1e6


class WrapsPeer(Protocol):
    """Puts something between the client and the arm: a Scenario, or a class of your own."""

    def wrap(self, peer: Peer, codec: Codec, *, clock: Clock, seed: int | None) -> Peer:
        """Return the peer that the client talks to in place of ``peer``."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmOptions:
    """The arguments of the mark.

    Attributes:
        edition: a name, or a package, for :func:`cobotwire.editions.load`.
        scenario: what goes wrong; None: nothing.
        transport: ``memory``, ``pty`` or ``tcp``; None: the fixture's default.
        speed: how fast the arm's time runs on a pty and over TCP: 2 is twice as fast.
        seed: replaces the scenario's seed; None: keeps it.
        folder: the folder of the test, where the scenario's file is looked for first.
    """

    edition: str = editions.DEFAULT
    scenario: str | WrapsPeer | None = None
    transport: str | None = None
    speed: float = 1.0
    seed: int | None = None
    folder: Path = Path()

    def wrapping(self, table: Table) -> WrapsPeer | None:
        """Return the scenario; read it, if it is a file or a name.

        Raises:
            UsageError: there is no such scenario.
            ScenarioError: the file is not a scenario.
        """
        if not isinstance(self.scenario, str):
            return self.scenario
        in_folder = self.folder / self.scenario
        return find(str(in_folder) if in_folder.is_file() else self.scenario, table)


def combined(
    marks: Iterable[tuple[tuple[Any, ...], Mapping[str, Any]]], folder: Path
) -> ArmOptions:
    """Combine the arguments of marks; a later mark overrides an earlier one.

    Raises:
        UsageError: an argument is not known or not allowed.
    """
    given: dict[str, Any] = {}
    known = [field.name for field in fields(ArmOptions) if field.name != "folder"]
    for places, names in marks:
        for value in places:
            message = f"simulated_arm takes arguments by name ({', '.join(known)}), not {value!r}"
            raise UsageError("simulated_arm", value, message=message)
        for name in names:
            if name not in known:
                hint = did_you_mean(name, known)
                message = f"simulated_arm has no argument {name}; it takes {', '.join(known)}{hint}"
                raise UsageError("simulated_arm", name, message=message)
        given |= names
    result = ArmOptions(**given, folder=folder)
    if result.transport not in (*TRANSPORTS, None):
        raise UsageError("transport", result.transport, f"one of {', '.join(TRANSPORTS)}")
    if not isinstance(result.speed, int | float) or not 0 < result.speed <= FASTEST:
        raise UsageError("speed", result.speed, f"above 0, up to {FASTEST:g}")
    scenario = result.scenario
    if not (scenario is None or isinstance(scenario, str) or hasattr(scenario, "wrap")):
        raise UsageError("scenario", scenario, "a file, a name, or an object with wrap()")
    return result
