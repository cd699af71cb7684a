"""The correct simulated arm with a fault that changes its requests or its replies."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from cobotwire.codec.interface import DecodedMessage, Noise
from cobotwire.protocol.table import Command, Table
from cobotwire.session import DeviceSession, RequestReceived, TextReceived
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.arm_connection import ArmConnection
from cobotwire.simulator.clock import Clock
from cobotwire.simulator.faults.exchange import Piece
from cobotwire.simulator.faults.outlet import Outlet
from mutation.device.cells import Stimulus, kind_of


class TimedBytes(NamedTuple):
    """Bytes that the device sends, ``delay`` seconds after the request."""

    delay: float
    data: bytes


# Takes the table, the request and what the correct arm sends; returns what is sent.
Change = Callable[[Table, DecodedMessage, bytes], bytes | list[TimedBytes]]


class Fault(NamedTuple):
    """The fault of a device: functions that replace correct behaviour; the defaults are correct.

    ``chunk`` notes a write, before its frames. ``request`` returns the bytes that the inner arm
    receives in place of a legal request, ``reply`` what is sent in place of the reply, which may be
    empty. ``malformed`` returns the reply to bytes that are not a legal request; a correct arm
    sends nothing. ``forgets`` returns a request that the arm then carries out by itself.
    """

    chunk: Callable[[bytes], None] = lambda data: None
    request: Callable[[Table, DecodedMessage, bytes], bytes] = lambda table, request, data: data
    reply: Change = lambda table, request, data: data
    malformed: Callable[[Table, Stimulus, bytes], bytes] = lambda table, kind, data: b""
    forgets: Callable[[Stimulus], bytes] = lambda kind: b""


def wrong_reply(command: Command, change: Change, *, also_silence: bool = False) -> Fault:
    """Change the reply to one command; a missing reply only with ``also_silence``."""

    def reply(table: Table, request: DecodedMessage, data: bytes) -> bytes | list[TimedBytes]:
        wrong = request.command is command and (data or also_silence)
        return change(table, request, data) if wrong else data

    return Fault(reply=reply)


class Mutant(NamedTuple):
    """A device with one fault.

    ``kind`` is the class of fault (``scale``), ``text`` what the device does wrong, and ``fault``
    makes the fault. ``command`` and ``field`` are its place; both are empty if it concerns the
    whole line.
    """

    kind: str
    text: str
    fault: Callable[[], Fault]
    command: str = ""
    field: str = ""

    @property
    def id(self) -> str:
        """The name in tables, unique within a suite."""
        place = ".".join(part for part in (self.command, self.field) if part)
        return ": ".join(part for part in (self.kind, place, self.text) if part)

    def make(self, table: Table, clock: Clock) -> BrokenArm:
        """Return a new device with the fault."""
        return BrokenArm(table, self.fault(), clock)


def mutant_of(kind: str, text: str, command: Command, change: Change, field: str = "") -> Mutant:
    """Return a device with a wrong reply to one command."""
    return Mutant(kind, text, partial(wrong_reply, command, change), command.name, field)


class BrokenArm(ArmConnection):
    """A connection to a simulated arm with a fault; a peer.

    The times and the order of its replies, acknowledgements and events are as on the correct arm. A
    fault changes single requests and replies.
    """

    def __init__(self, table: Table, fault: Fault, clock: Clock) -> None:
        self._correct = SimulatedArm(table, clock=clock)
        super().__init__(self._correct, None)
        self._fault = fault
        # The bytes that are sent later.
        self._late = Outlet()
        # Whether the arm did not receive the last request, so that its text is lost, too.
        self._lost = False

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        wait = super().wait
        if self._late.next is None:
            return wait
        left = max(0.0, self._late.next - self._arm.clock())
        return left if wait is None else min(wait, left)

    def receive(self, data: bytes) -> bytes:
        """Take ``data``; return what is sent at once."""
        self._fault.chunk(data)
        return self._late.take(self._arm.clock()) + super().receive(data)

    def flush(self) -> bytes:
        """Let time pass; return what is due by now."""
        late = self._late.take(self._arm.clock())
        if self._arm.clock() < self._idle_at:
            return late + self.take_events()
        return late + super().flush()

    def _handle_all(self, events: list[DeviceEvent]) -> bytes:
        # Noise is examined as a whole, because a broken request is rejected byte by byte.
        sent = noise = b""
        for event in events:
            if isinstance(event, Noise):
                noise += event.data
                continue
            if isinstance(event, TextReceived):
                sent += b"" if self._lost else self._handle(event)
                continue
            sent += self._after_noise(noise)
            noise = b""
            if isinstance(event, RequestReceived):
                sent += self._after_request(event)
            else:
                sent += self._after_malformed("illegal value", event.frame.data)
        return sent + self._after_noise(noise)

    def _after_request(self, received: RequestReceived) -> bytes:
        """Return what is sent at once in reply to a legal request."""
        message, data = received.message, received.frame.data
        changed = self._fault.request(self._arm.table, message, data)
        self._lost = not changed
        answer = b"".join(map(self._handle, self._read_again(received, changed)))
        sent, parts = b"", self._fault.reply(self._arm.table, message, answer)
        for delay, part in [TimedBytes(0.0, parts)] if isinstance(parts, bytes) else parts:
            if delay <= 0:
                sent += part
            elif part:
                self._late.put(self._arm.clock() + delay, (Piece(0.0, part),))
        return sent

    def _read_again(self, received: RequestReceived, changed: bytes) -> list[DeviceEvent]:
        if changed == received.frame.data:
            return [received]
        return DeviceSession(self._arm.codec).receive(changed)

    def _after_noise(self, noise: bytes) -> bytes:
        return self._after_malformed(kind_of(self._arm.table, noise), noise) if noise else b""

    def _after_malformed(self, kind: Stimulus, data: bytes) -> bytes:
        if request := self._fault.forgets(kind):
            # The arm sends its acknowledgement to a connection that is never read.
            self._correct.receive(request)
        return self._fault.malformed(self._arm.table, kind, data)
