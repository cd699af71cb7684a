"""A client's connection to the simulated arm: requests in, replies and events out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Reply
from cobotwire.protocol.table import Command, Table
from cobotwire.session import DeviceSession, RequestReceived, TextReceived
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator.behaviour import Sized
from cobotwire.simulator.behaviour.registry import Unanswerable
from cobotwire.simulator.devices import missing_joints, replies_to
from cobotwire.simulator.events import Events
from cobotwire.simulator.peer import IDLE_SECONDS
from cobotwire.simulator.replies import PREFIX, clamped, completed, refusal

EventListener = Callable[[DeviceEvent, bytes], None]
"""Takes an event of a connection and the bytes of the reply; empty: there is no reply."""


# What performing a command returns for the reply.
Done = Reply[Any] | Sized | Mapping[str, Any] | None


class ConnectedArm(Protocol):
    """What a connection needs of its arm."""

    codec: Codec
    acks: bool
    events: Events

    @property
    def table(self) -> Table:
        """The edition that the arm speaks."""

    @property
    def clock(self) -> Callable[[], float]:
        """Returns the time in seconds."""

    def receivers(self, address: int | None) -> tuple[int | None, ...]:
        """Return the addresses of the devices that receive a request to an address."""

    def perform(self, command: Command, fields: Mapping[str, Any], address: int | None) -> Done:
        """Perform a command; return the reply or some of its fields; the arm fills in the rest."""

    def note(self, command: Command, text: str) -> None:
        """Add a note."""

    def restart(self) -> None:
        """Lose all settings, as in a power cycle."""


class ArmConnection:
    """One client's connection to the arm: a peer that parses requests and encodes replies."""

    def __init__(self, arm: ConnectedArm, on_event: EventListener | None) -> None:
        self._arm = arm
        self._on_event = on_event
        self._received = 0
        self.reset()

    @property
    def pending(self) -> int:
        """The number of bytes of an incomplete request."""
        return self._session.pending

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        wait = self._arm.events.wait(self._received)
        return IDLE_SECONDS if wait is None and self.pending else wait

    def receive(self, data: bytes) -> bytes:
        """Receive ``data``; return the replies, after the events that are due."""
        due = self.take_events()
        self._idle_at = self._arm.clock() + IDLE_SECONDS
        return due + self._handle_all(self._session.receive(data))

    def flush(self) -> bytes:
        """Give up an incomplete request if nothing more has come; return replies and events."""
        waits = self._arm.events.wait(self._received) is not None
        early = waits and self._arm.clock() < self._idle_at
        due = self.take_events()
        if early:
            return due
        return due + self._handle_all(self._session.flush())

    def take_events(self) -> bytes:
        """Return the events that are due for this client."""
        due = self._arm.events.since(self._received)
        self._received = self._arm.events.count
        return due

    def restart(self) -> None:
        """Restart the arm, and forget an incomplete request of this client."""
        self._arm.restart()
        self.reset()

    def forget_client(self) -> None:
        """Forget an incomplete request; its client has left."""
        self.reset()

    def reset(self) -> None:
        """Forget an incomplete request, and events that this client has not received."""
        self._session = DeviceSession(self._arm.codec)
        self._received = self._arm.events.count
        self._idle_at = 0.0

    def _handle_all(self, events: list[DeviceEvent]) -> bytes:
        replies = b""
        for event in events:
            reply = self._handle(event)
            if self._on_event is not None:
                self._on_event(event, reply)
            replies += reply
        return replies

    def _handle(self, event: DeviceEvent) -> bytes:
        if isinstance(event, RequestReceived):
            message = event.message
            receivers = self._arm.receivers(message.address)
            replies = [self._reply_of(event, each) for each in receivers]
            frames = [b"" if reply.startswith(PREFIX) else reply for reply in replies]
            # Where one of several devices can reply, the others need not say why they cannot.
            replies = frames if any(frames) else replies
            return b"".join(replies_to(self._arm.table, message.address, replies))
        if isinstance(event, TextReceived):
            for address in self._arm.receivers(event.address):
                self._arm.perform(event.command, event.fields, address)
        # The document has no error reply: noise and malformed requests get none.
        return b""

    def _reply_of(self, received: RequestReceived, address: int | None) -> bytes:
        """Perform a request on the device that has an address; return its reply."""
        command, given = received.message.command, received.message.fields
        missing = missing_joints(self._arm.table, command, given, address)
        if missing:
            self._arm.note(command, f"ignored: {missing}")
            return b""
        # A command with a text after its frame is performed once the text is complete.
        performed = command.request_text is None
        try:
            reply = self._arm.perform(command, given, address) if performed else None
        except Unanswerable as error:
            why = str(error) or self._arm.table.robot.why_no_geometry
            if command.safety == "query":
                self._arm.note(command, f"no reply: {why}")
                return refusal(why)
            # A rejected request is acknowledged, too. No text is sent: the maker's library could
            # not read an acknowledgement after it.
            self._arm.note(command, f"rejected: {why}")
            return self._encode_reply(command, given, None, address)
        return self._encode_reply(command, given, reply, address)

    def _encode_reply(
        self,
        command: Command,
        given: Mapping[str, Any],
        reply: Done,
        address: int | None,
    ) -> bytes:
        """Return the bytes of a reply or an acknowledgement; empty if the command has none."""
        if not command.requires_reply and not (command.ack and self._arm.acks):
            return b""
        if isinstance(reply, Sized):
            return self._encode_sized(command, reply, address)
        result = reply.fields if isinstance(reply, Reply) else reply or {}
        fields = completed(command, given, result)
        try:
            return self._session.encode_reply(command.name, fields, address)
        except UsageError as error:
            if command.text is not None:
                self._arm.note(command, f"no reply: {error}")
                return refusal("the text has characters that a reply cannot have")
            # The wire has no value for a distant pose, or for some limits.
            self._arm.note(command, "replied with the nearest value that the wire can express")
            nearest = clamped(command, result, fields)
            return self._session.encode_reply(command.name, nearest, address)

    def _encode_sized(self, command: Command, sized: Sized, address: int | None) -> bytes:
        """Return the bytes of a reply in the variant with its number of data bytes."""
        [variant] = [i for i, each in enumerate(command.reply) if each.size == sized.size]
        encode, values = self._arm.codec.encode, sized.reply.values
        return encode(command.name, "reply", values, variant=variant, address=address)
