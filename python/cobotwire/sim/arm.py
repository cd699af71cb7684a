"""The simulated arm without a port: requests' bytes in, replies' bytes out."""

from __future__ import annotations

import copy
import time
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.errors import UsageError
from cobotwire.session import Asked, DeviceSession, Told
from cobotwire.session.device import DeviceEvent
from cobotwire.sim.answers import complete, sayable
from cobotwire.sim.behaviour import BEHAVIOUR
from cobotwire.sim.kinematics import Geometry, geometry_of
from cobotwire.sim.state import ArmState
from cobotwire.table import Command, Table

# A joint's limit lies inside half a turn; what is wider is only what the wire can say.
HALF_TURN = 180.0
# A request that stands still this long is given up, so that the next one is not taken for its rest.
IDLE_SECONDS = 0.2

Clock = Callable[[], float]
Watch = Callable[[DeviceEvent, bytes], None]
# Notes beyond this push the oldest ones out.
NOTES_KEPT = 1000


class Note(NamedTuple):
    """What no answer tells: that an order is ignored, is refused or has to wait, and why.

    ``time`` is by the arm's clock, ``command`` the order's name.
    """

    time: float
    command: str
    text: str


class SimulatedArm:
    """An arm of an edition. Give it a clock of your own to step time."""

    def __init__(
        self,
        table: Table,
        *,
        clock: Clock = time.monotonic,
        codec: codecs.CodecName | None = None,
        watch: Watch | None = None,
        acks: bool = True,
        geometry: Geometry | None = None,
        remark: Callable[[Note], None] | None = None,
    ) -> None:
        """Make an arm that is switched off and stands at zero.

        Args:
            table: the edition that it speaks.
            clock: gives the time in seconds.
            codec: ``native`` or ``reference``; left out: the one in use.
            watch: called with everything that was heard and what was answered.
            acks: whether it acknowledges what the edition says it may.
            geometry: where its end is for its joints; left out: that of the arm which speaks this
                edition. Where none is known, coordinates are answered with zeros, and an order to
                go to some is refused; the joints move, but stand on no ticks.
            remark: called with each note when it is made; ``notes`` has the last thousand.
        """
        self.table = table
        self._clock = clock
        self._watch = watch
        self._acks = acks
        self._remark = remark
        self._notes: deque[Note] = deque(maxlen=NOTES_KEPT)
        self._geometry = geometry or geometry_of(table)
        self._codec = codecs.load(table, codec)
        # In a list that all lines of this arm share, so that each sees when it is replaced.
        self._states = [self._fresh()]
        self._session = DeviceSession(self._codec)

    @property
    def state(self) -> ArmState:
        """What the arm remembers, whoever told it."""
        return self._states[0]

    @state.setter
    def state(self, state: ArmState) -> None:
        self._states[0] = state

    def another_line(self, watch: Watch | None = None) -> SimulatedArm:
        """The same arm for one more client: its state is shared, its requests are its own.

        ``watch`` is called with what this client says; left out: as for the first one.
        """
        line = copy.copy(self)
        line._watch = watch or self._watch
        line._session = DeviceSession(self._codec)
        return line

    def restart(self) -> None:
        """Lose all state, as when power goes and comes back.

        What the arm is made of keeps its place: joints and gripper stand where they stood. The
        controller counts its starts.
        """
        now, before = self._clock(), self.state
        self.state = self._fresh()
        self.state.angles.place(before.standing(now), now)
        self.state.gripper.place(before.gripper.position(now), now)
        self.state.starts = before.starts + 1
        self._session = DeviceSession(self._codec)

    def _fresh(self) -> ArmState:
        state = ArmState(self.table.joints, self._geometry)
        for joint, (lowest, highest) in enumerate(_joint_limits(self.table)):
            state.minimum[joint], state.maximum[joint] = lowest, highest
        return state

    @property
    def notes(self) -> tuple[Note, ...]:
        """What no answer told so far, the oldest first: at most a thousand notes."""
        return tuple(self._notes)

    @property
    def pending(self) -> int:
        """Bytes of a request that is not whole yet."""
        return self._session.pending

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`flush` must be called if nothing is heard; None: never."""
        return IDLE_SECONDS if self.pending else None

    def receive(self, data: bytes) -> bytes:
        """Hear ``data``; gives what the arm answers at once."""
        return self._answer_all(self._session.receive(data))

    def flush(self) -> bytes:
        """The line has been idle: a request that is not whole by now is given up."""
        return self._answer_all(self._session.flush())

    def _answer_all(self, events: list[DeviceEvent]) -> bytes:
        said = b""
        for event in events:
            # Noise and malformed requests are not answered: the document knows no error reply.
            answer = self._answer(event) if isinstance(event, Asked) else b""
            if isinstance(event, Told):
                self._do(event.command, event.fields)
            if self._watch is not None:
                self._watch(event, answer)
            said += answer
        return said

    def _answer(self, asked: Asked) -> bytes:
        command, given = asked.message.command, asked.message.fields
        # A request with a text behind it is done when the text has come.
        result = {} if command.request_text is not None else self._do(command, given)
        if not command.answers and not (command.ack and self._acks):
            return b""
        values = complete(command, given, result)
        try:
            return self._session.answer(command.name, values)
        except UsageError:
            # A pose far out in the world, or a limit: no wire has a word for it.
            self._note(command, "answered with the nearest that the wire can say")
            return self._session.answer(command.name, sayable(command, result, values))

    def _do(self, command: Command, given: Mapping[str, Any]) -> dict[str, Any]:
        handler = BEHAVIOUR.get(command.name)
        if handler is None:
            return {}
        state, now = self.state, self._clock()
        result = handler(state, now, **given) or {}
        for text in state.remarks:
            self._note(command, text)
        state.remarks.clear()
        return result

    def _note(self, command: Command, text: str) -> None:
        note = Note(self._clock(), command.name, text)
        self._notes.append(note)
        if self._remark is not None:
            self._remark(note)


def _joint_limits(table: Table) -> list[tuple[float, float]]:
    """The limits that the edition gives each joint; none where it gives only the wire's own."""
    for command in table.commands:
        if command.role == "joint targets":
            numbers = command.request[0].fields[0].cases[0].numbers
            limits = [(n.minimum / n.divide, n.maximum / n.divide) for n in numbers]
            return limits if all(high <= HALF_TURN for _, high in limits) else []
    return []
