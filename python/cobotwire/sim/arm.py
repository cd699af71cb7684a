"""The simulated arm without a port: requests' bytes in, replies' bytes out."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from cobotwire import codec as codecs
from cobotwire.session import Asked, DeviceSession
from cobotwire.session.device import DeviceEvent
from cobotwire.sim.behaviour import BEHAVIOUR
from cobotwire.sim.state import ArmState
from cobotwire.table import Command, Field, Table

Clock = Callable[[], float]
Watch = Callable[[DeviceEvent, bytes], None]


class SimulatedArm:
    """An arm of an edition. Give it a clock of your own to step time."""

    def __init__(
        self,
        table: Table,
        *,
        clock: Clock = time.monotonic,
        codec: codecs.CodecName | None = None,
        watch: Watch | None = None,
    ) -> None:
        """Make an arm that is switched off and stands at zero.

        Args:
            table: the edition that it speaks.
            clock: gives the time in seconds.
            codec: ``native`` or ``reference``; left out: the one in use.
            watch: called with everything that was heard and what was answered.
        """
        self.table = table
        self.state = ArmState(table.joints)
        self._clock = clock
        self._watch = watch
        self._session = DeviceSession(codecs.load(table, codec))

    @property
    def pending(self) -> int:
        """Bytes of a request that is not whole yet."""
        return self._session.pending

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
            if self._watch is not None:
                self._watch(event, answer)
            said += answer
        return said

    def _answer(self, asked: Asked) -> bytes:
        command, given = asked.message.command, asked.message.fields
        handler = BEHAVIOUR.get(command.name)
        result = handler(self.state, self._clock(), **given) if handler else None
        if not command.answers:
            return b""
        return self._session.answer(command.name, _complete(command, given, result or {}))


def _complete(command: Command, given: dict[str, Any], result: dict[str, Any]) -> dict[str, Any]:
    """Fill a reply up: echoes from the request, the rest with what is legal and nearest to zero."""
    if command.text is not None:
        return {name: result.get(name, "") for name in command.text.fields}
    fields = command.reply[0].fields
    return {
        field.name: given[field.name] if field.echo else result.get(field.name, _neutral(field))
        for field in fields
    }


def _neutral(field: Field) -> Any:
    numbers = field.cases[0].numbers
    values = [
        field.choices[0] if field.choices else min(max(0, number.minimum), number.maximum)
        for number in numbers
    ]
    scaled = [
        value * number.multiply / number.divide if number.scaled else value
        for value, number in zip(values, numbers)
    ]
    return scaled if field.many else scaled[0]
