"""Events of a simulated arm: the end of a motion, if its edition has a message for that."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cobotwire.codec.interface import Codec
from cobotwire.protocol.roles import starts_motion
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.replies import completed
from cobotwire.simulator.state import ArmState

# The interval, in seconds, at which a moving arm is checked for having stopped.
CHECK_SECONDS = 0.01


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
        self._table, self._codec, self._clock, self._states = table, codec, clock, states
        self._gives_reasons = self._event is not None and self._event.accepted == (0,)
        self._watched: set[int | None] = set()
        # The status of motions that did not reach their target, by the address of the device.
        self._failed: dict[int | None, int] = {}

    def watch(self, command: Command, address: int | None) -> None:
        """Note that a device has performed a command: if it moves now, the end is reported."""
        state = self._states[address]
        rejection, state.rejection = state.rejection, None
        at_once, state.at_once = state.at_once, False
        if self._event is None:
            return
        codes, starts = state.error_codes, starts_motion(self._table, command)
        if command.role == "stop" and address in self._watched:
            self._failed[address] = codes.stopped
        elif at_once or (starts and state.angles.moving(self._clock())):
            self._watched.add(address)
        elif starts and rejection is not None:
            self._failed[address] = rejection or (
                codes.no_solution if state.held else codes.no_power
            )
            if self._gives_reasons:
                self._watched.add(address)

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`due` may have something to report; None: no device is watched."""
        return CHECK_SECONDS if self._watched else None

    def due(self) -> bytes:
        """Return the events of the motions that have ended by now."""
        if self._event is None:
            return b""
        now, sent = self._clock(), b""
        for address in sorted(self._watched, key=lambda address: address or 0):
            if not self._states[address].angles.moving(now):
                self._watched.discard(address)
                if not self._states[address].reports_ends:
                    self._failed.pop(address, None)
                    continue
                fields = completed(self._event, {}, {}, usual=1)
                status = self._failed.pop(address, None)
                if status is not None and self._gives_reasons:
                    fields[self._event.reply[0].fields[-1].name] = status
                values = list(fields.values())
                sent += self._codec.encode(self._event.name, "reply", values, address=address)
        return sent
