"""Which simulated arm a test wants."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Protocol

from cobotwire import editions
from cobotwire.codec.interface import Codec
from cobotwire.errors import UsageError
from cobotwire.sim.clock import Clock
from cobotwire.sim.peer import Peer
from cobotwire.table import Table

LINKS = ("memory", "pty", "tcp")
FASTEST = 1e6


class Wraps(Protocol):
    """What puts something between the client and the arm: a Scenario, or a class of one's own."""

    def wrap(self, peer: Peer, codec: Codec, *, clock: Clock, seed: int | None) -> Peer:
        """The peer that the client talks to in place of ``peer``."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """The arguments of the mark.

    Attributes:
        edition: as :func:`cobotwire.editions.load` takes it.
        scenario: what goes wrong; None: nothing.
        link: ``memory``, ``pty`` or ``tcp``; None: what the fixture takes by default.
        speed: on a pty and over TCP the arm's time: 2 runs twice as fast.
        seed: in place of the scenario's.
        folder: where the test is, from which the scenario's file is looked for.
    """

    edition: str = editions.DEFAULT
    scenario: str | Wraps | None = None
    link: str | None = None
    speed: float = 1.0
    seed: int | None = None
    folder: Path = Path()

    def wrapping(self, table: Table) -> Wraps | None:
        """The scenario, read if it is a file's or a name.

        Raises:
            UsageError: there is no such scenario.
            ScenarioError: the file is none.
        """
        if not isinstance(self.scenario, str):
            return self.scenario
        # Here, not above: most tests have an arm without faults.
        from cobotwire.sim.faults import find

        beside = self.folder / self.scenario
        return find(str(beside) if beside.is_file() else self.scenario, table)


def wanted(marks: Iterable[tuple[tuple[Any, ...], Mapping[str, Any]]], folder: Path) -> Wanted:
    """What these marks say together; a later one goes before an earlier one.

    Raises:
        UsageError: an argument is not known or not allowed.
    """
    given: dict[str, Any] = {}
    known = [field.name for field in fields(Wanted) if field.name != "folder"]
    for places, names in marks:
        for value in places:
            raise UsageError("simulated_arm", value, f"arguments by name: {', '.join(known)}")
        for name in names:
            if name not in known:
                near = "".join(
                    f"; did you mean {one}?" for one in get_close_matches(name, known, 1)
                )
                raise UsageError("simulated_arm", name, f"one of {', '.join(known)}{near}")
        given |= names
    result = Wanted(**given, folder=folder)
    if result.link not in (*LINKS, None):
        raise UsageError("link", result.link, f"one of {', '.join(LINKS)}")
    if not isinstance(result.speed, int | float) or not 0 < result.speed <= FASTEST:
        raise UsageError("speed", result.speed, f"above 0, up to {FASTEST:g}")
    scenario = result.scenario
    if not (scenario is None or isinstance(scenario, str) or hasattr(scenario, "wrap")):
        raise UsageError("scenario", scenario, "a file, a name, or an object with wrap()")
    return result
