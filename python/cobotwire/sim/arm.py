"""The simulated arm without a port: requests' bytes in, replies' bytes out."""

from __future__ import annotations

import copy
import time
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.session import Asked, DeviceSession, Told
from cobotwire.session.device import DeviceEvent
from cobotwire.sim.behaviour import BEHAVIOUR
from cobotwire.sim.kinematics import Geometry, geometry_of
from cobotwire.sim.state import ArmState
from cobotwire.table import Command, Field, Table

# A joint's limit lies inside half a turn; what is wider is only what the wire can say.
HALF_TURN = 180.0
# A request that stands still this long is given up, so that the next one is not taken for its rest.
IDLE_SECONDS = 0.2

Clock = Callable[[], float]
Watch = Callable[[DeviceEvent, bytes], None]
# Notes beyond this push the oldest ones out.
NOTES_KEPT = 1000


class Note(NamedTuple):
    """What no answer tells: that an order is ignored, or refused, and why.

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
        self._states = [ArmState(table.joints, self._geometry)]
        self.restart()

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
        """Lose all state, as when power goes and comes back."""
        self.state = ArmState(self.table.joints, self._geometry)
        for joint, (lowest, highest) in enumerate(_joint_limits(self.table)):
            self.state.minimum[joint], self.state.maximum[joint] = lowest, highest
        self._session = DeviceSession(self._codec)

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
        return self._session.answer(command.name, _complete(command, given, result))

    def _do(self, command: Command, given: Mapping[str, Any]) -> dict[str, Any]:
        handler = BEHAVIOUR.get(command.name)
        if handler is None:
            return {}
        state, now = self.state, self._clock()
        result = handler(state, now, **given) or {}
        for text in state.remarks:
            note = Note(now, command.name, text)
            self._notes.append(note)
            if self._remark is not None:
                self._remark(note)
        state.remarks.clear()
        return result


def _joint_limits(table: Table) -> list[tuple[float, float]]:
    """The limits that the edition gives each joint; none where it gives only the wire's own."""
    for command in table.commands:
        if command.role == "joint targets":
            numbers = command.request[0].fields[0].cases[0].numbers
            limits = [(n.minimum / n.divide, n.maximum / n.divide) for n in numbers]
            return limits if all(high <= HALF_TURN for _, high in limits) else []
    return []


def _complete(command: Command, given: dict[str, Any], result: dict[str, Any]) -> dict[str, Any]:
    """Fill a reply up: echoes from the request, the rest with what is legal and usual."""
    if command.text is not None:
        return {name: result.get(name, "") for name in command.text.fields}
    form = command.reply[_form(command, result)]
    # An acknowledgement says 1, done.
    usual = 1 if command.ack else 0
    return {
        field.name: given[field.name]
        if field.echo
        else _sayable(field, result.get(field.name, _near(field, usual)))
        for field in form.fields
    }


def _sayable(field: Field, value: Any) -> Any:
    """The value; where the wire has no room for it, as behind a long tool, the end of the range."""
    if field.choices or not any(number.scaled for number in field.cases[0].numbers):
        return value
    parts = [
        min(max(part, n.minimum * n.multiply / n.divide), n.maximum * n.multiply / n.divide)
        for part, n in zip(value if field.many else (value,), field.cases[0].numbers)
    ]
    return tuple(parts) if field.many else parts[0]


def _form(command: Command, result: dict[str, Any]) -> int:
    """The first form of the reply that has room for the whole result."""
    for index, form in enumerate(command.reply):
        if set(result) <= {field.name for field in form.fields}:
            return index
    return 0


def _near(field: Field, usual: int) -> Any:
    """The legal value that is nearest to the usual one."""
    numbers = field.cases[0].numbers
    values = [
        field.choices[0] if field.choices else min(max(usual, number.minimum), number.maximum)
        for number in numbers
    ]
    scaled = [
        value * number.multiply / number.divide if number.scaled else value
        for value, number in zip(values, numbers)
    ]
    return scaled if field.many else scaled[0]
