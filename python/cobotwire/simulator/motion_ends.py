"""Events of a simulated arm: the end of a motion, if its edition has a message for that."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cobotwire.codec.interface import Codec
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.replies import completed
from cobotwire.simulator.state import ArmState

# How often a moving arm looks whether it has come to rest.
LOOK_SECONDS = 0.01


class MotionEnds:
    """Watches the motions that a client has started, and reports each one once."""

    def __init__(
        self,
        table: Table,
        codec: Codec,
        clock: Callable[[], float],
        states: Mapping[int | None, ArmState],
    ) -> None:
        """Report motions of ``states``, which are the devices by their addresses."""
        self._event = table.find_role("motion ended")
        self._codec, self._clock, self._states = codec, clock, states
        self._watched: set[int | None] = set()

    def watch(self, command: Command, address: int | None) -> None:
        """Note that a device has performed a command: if it moves now, the end is reported."""
        moves = self._states[address].angles.moving(self._clock())
        if self._event is not None and command.starts_motion and moves:
            self._watched.add(address)

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`due` may have something to report; None: no device is watched."""
        return LOOK_SECONDS if self._watched else None

    def due(self) -> bytes:
        """Return the events of the motions that have ended by now."""
        if self._event is None:
            return b""
        now, sent = self._clock(), b""
        for address in sorted(self._watched, key=lambda address: address or 0):
            if not self._states[address].angles.moving(now):
                self._watched.discard(address)
                fields = completed(self._event, {}, {}, usual=1)
                values = list(fields.values())
                sent += self._codec.encode(self._event.name, "reply", values, address=address)
        return sent
