"""Sends requests to the device and sorts what comes back."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.conformance.device.connection import DeviceConnection
from cobotwire.conformance.device.response import ReceivedReply, Response
from cobotwire.diagnose import Diagnoser, Finding
from cobotwire.protocol.addresses import addresses_of, lacks_joints
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Address, Command, TextReply
from cobotwire.session.acks import MOTION_SECONDS
from cobotwire.session.events import EventReceived
from cobotwire.session.matching import as_event, can_come_from, can_reply_to
from cobotwire.session.request import EncodedRequest, RequestEncoder, as_call
from cobotwire.session.text import TextCollector


@dataclass(frozen=True, slots=True)
class Timing:
    """How long the tester listens, in seconds.

    ``linger`` after a reply, for a second one; ``silence`` where no reply is due; ``grace`` after
    a deadline, for late replies (delays of up to 727 ms were observed); ``idle`` until an arm gives
    up half a request; ``pause`` between the pieces of a request.
    """

    linger: float = 0.004
    silence: float = 0.03
    grace: float = 0.3
    idle: float = 0.25
    pause: float = 0.01


# After this many commands without an acknowledgement in time, an arm counts as one that sends none.
ENOUGH_SILENT = 4


class Requester:
    """Sends requests of one edition on one connection, and returns the response to each."""

    def __init__(
        self,
        connection: DeviceConnection,
        codec: Codec,
        timing: Timing,
        address: Address | None = None,
    ) -> None:
        self._connection = connection
        self._codec = codec
        self._timing = timing
        self._requests = RequestEncoder(codec, address)
        self._devices: dict[int | None, Address] = {d.value: d for d in addresses_of(codec.table)}
        self._framer = codec.framer("reply")
        self._diagnoser = Diagnoser(codec)
        # Most requests are repeated, so each is described once.
        self._descriptions: dict[tuple[str, bytes], str] = {}
        # The last two requests, of different commands, that had a reply.
        self._replied: list[EncodedRequest] = []
        # The one-way requests that may still be acknowledged, oldest first.
        self._unacknowledged: list[Response] = []
        # The events that the device has sent, each with the time at which it was received.
        self.events: list[tuple[float, EventReceived]] = []
        # How long the slowest acknowledgement took, motions excepted; None: there was none.
        self._slowest: float | None = None
        # The commands that were not acknowledged in time.
        self._silent: set[str] = set()

    def prepare(self, request: Request[Any]) -> EncodedRequest:
        """Validate and encode a request.

        Raises:
            UsageError: the edition does not allow the arguments.
        """
        return self._requests.encode_request(request)

    @contextmanager
    def addressed(self, address: Address) -> Iterator[None]:
        """Send all requests of a ``with`` block to another device."""
        usual, self._requests = self._requests, RequestEncoder(self._codec, address)
        try:
            yield
        finally:
            self._requests = usual

    def is_legal(self, data: bytes) -> bool:
        """Return whether bytes are a legal request of any command."""
        try:
            self._codec.decode("request", data)
        except ProtocolError:
            return False
        return True

    def describe(self, request: EncodedRequest) -> str:
        """Return a request as a person writes it: ``get_encoder(joint=1)``."""
        key = request.command.name, request.frame
        found = self._descriptions.get(key)
        if found is None:
            found = self._descriptions[key] = as_call(request, self._codec)
        return found

    def send(self, request: EncodedRequest) -> Response:
        """Send a request, and listen until its reply has come or cannot come any more."""
        return self.send_instead(request, request.frame, self.describe(request))

    def send_instead(self, request: EncodedRequest, data: bytes, note: str) -> Response:
        """Send ``data`` instead of a request's frame, and listen as if for its reply."""
        response = self._begin(request, data, note)
        command = request.command
        if request.text:
            self._connection.send(request.text, "the text of the request")
        if command.text is not None:
            self._await_text(response, command.text)
        elif command.requires_reply:
            self._await_reply(response, command.deadline_ms / 1000)
        elif command.ack:
            self._unacknowledged.append(response)
            self._await_reply(response, self._patience(command))
            if not response.replies and command.safety != "motion":
                self._silent.add(command.name)
        self.listen(response, self._after(response))
        return response

    def send_bytes(
        self, request: EncodedRequest, data: bytes, note: str, seconds: float
    ) -> Response:
        """Send ``data``, to which no reply is due, and listen for ``seconds``.

        If acknowledgements of this device take longer, it listens longer, too.
        """
        self._await_late(request.command.id)
        if request.command.ack and self._slowest is not None:
            seconds = max(seconds, self._slowest + self._timing.silence)
        response = self._begin(request, data, note)
        self.listen(response, seconds)
        return response

    def await_acknowledgements(self) -> None:
        """Wait until each acknowledgement has come or is too late, but not for those of motions."""
        for id in {each.request.command.id for each in self._unacknowledged}:
            self._await_late(id)

    def _await_late(self, id: int) -> None:
        """Wait for late acknowledgements: they would be taken for replies to the next request."""
        late = [each for each in self._unacknowledged if each.request.command.id == id]
        for each in () if self._slowest is None else late:
            left = self._too_late(each) - self._connection.now
            if each.request.command.safety != "motion" and left > 0 and not each.replies:
                self.listen(each, left)
        self._unacknowledged = [e for e in self._unacknowledged if e.request.command.id != id]

    def _patience(self, command: Command) -> float:
        """Return how long to wait for an acknowledgement: not long if it is unlikely to come.

        Some firmware acknowledges a motion only when it ends.
        """
        none = self._slowest is None and len(self._silent) >= ENOUGH_SILENT
        unlikely = command.safety == "motion" or none or command.name in self._silent
        return self._timing.silence if unlikely else command.deadline_ms / 1000

    def _too_late(self, response: Response) -> float:
        """Return when a frame can no longer be the acknowledgement of a request."""
        command = response.request.command
        late = command.deadline_ms / 1000 + self._timing.grace
        return response.sent_at + (MOTION_SECONDS if command.safety == "motion" else late)

    def _begin(self, request: EncodedRequest, data: bytes, note: str) -> Response:
        """Send; return an empty response, which names the last request of another command."""
        self._connection.send(data, note)
        others = [each for each in self._replied if each.command.id != request.command.id]
        return Response(request, self._connection.now, others[-1] if others else None)

    def listen(self, response: Response, seconds: float) -> None:
        """Listen until nothing has come for ``seconds``, and classify all that was received."""
        end = self._connection.now + max(self._timing.grace, 4 * seconds)
        while self._connection.now < end and (data := self._connection.receive(seconds)):
            self._sort(response, self._framer.feed(data))
        self._sort(response, self._framer.flush())
        self._keep(response, self._diagnoser.flush())

    def _after(self, response: Response) -> float:
        """Return how long to listen for a second reply, a late one, or one that is not due."""
        command = response.request.command
        if command.requires_reply and not response.replies:
            return self._timing.grace
        # If an acknowledgement was awaited in vain, the silence has already been observed.
        waited = bool(response.replies) or command.ack
        return self._timing.linger if waited else self._timing.silence

    def _await_reply(self, response: Response, seconds: float) -> None:
        """Listen until a reply has come or ``seconds`` have passed.

        If this process is delayed, a reply that waits to be read still counts as in time.
        """
        end, left = response.sent_at + seconds, seconds
        while not response.replies and left > 0:
            self._sort(response, self._framer.feed(self._connection.receive(left)))
            left = end - self._connection.now
        response.late = not response.replies

    def _await_text(self, response: Response, variant: TextReply) -> None:
        """Receive until the line is silent: text has no frame that would end it."""
        end = response.sent_at + response.request.command.deadline_ms / 1000
        received, first = b"", 0.0
        while data := self._connection.receive(
            variant.silence_ms / 1000 if received else end - self._connection.now
        ):
            first = first or self._connection.now - response.sent_at
            received += data
        self._read_text(response, variant, received, first)

    def _read_text(
        self, response: Response, variant: TextReply, received: bytes, seconds: float
    ) -> None:
        """Find the text in the received bytes; the framer gets the rest."""
        begins = received.find(variant.prefixes[0].encode("ascii"))
        if begins < 0:
            self._sort(response, self._framer.feed(received))
            return
        text, rest = _first_line(received[begins:])
        collector = TextCollector(variant)
        collector.add(text, 0.0)
        try:
            message = _typed(response.request.command, collector.decode())
            response.replies.append(ReceivedReply(seconds, text, message=message))
        except ProtocolError as error:
            response.replies.append(ReceivedReply(seconds, text, error))
        self._sort(response, self._framer.feed(received[:begins] + rest))

    def _sort(self, response: Response, events: list[Event]) -> None:
        """Keep frames at once, and feed all events to the diagnoser: noise may need later bytes."""
        for event in events:
            if not isinstance(event, Frame):
                continue
            if (unrequested := as_event(event, self._codec.table)) is not None:
                self.events.append((self._connection.now, unrequested))
                continue
            owner = self._owner(event, response)
            if owner is None:
                response.others.append(event)
                continue
            command = owner.request.command
            self._replied = [e for e in self._replied if e.command is not command][-1:]
            self._replied.append(owner.request)
            seconds = self._connection.now - owner.sent_at
            owner.replies.append(self._read(event, seconds, command))
            if command.ack and command.safety != "motion":
                self._slowest = max(self._slowest or 0.0, seconds)
                self._silent.discard(command.name)
        self._keep(response, self._diagnoser.feed(events))

    def _owner(self, frame: Frame, response: Response) -> Response | None:
        """Return the response that a frame belongs to; None if it replies to no request.

        A late acknowledgement belongs to the oldest request that can have it.
        """
        now, request = self._connection.now, response.request
        own = bool(request.command.reply) and request.can_have_reply(frame)
        own = own and self._can_come_from(self._codec.table.frame.address(frame.data), request)
        waiting = [each for each in self._unacknowledged if self._too_late(each) > now]
        late = () if own and request.command.requires_reply else waiting
        owner = next((each for each in late if can_reply_to(frame, each.request)), None)
        owner = owner or (response if own else None)
        self._unacknowledged = [each for each in waiting if each is not owner]
        return owner

    def _can_come_from(self, address: int | None, request: EncodedRequest) -> bool:
        """Return whether a reply of an address can belong to a request.

        If a request is for several devices, any of them that has the joints may reply.
        """
        device = self._devices.get(address)
        lacks = lacks_joints(self._codec.table, device, request.command)
        return can_come_from(address, request) and not lacks

    def _keep(self, response: Response, items: Sequence[Frame | Finding]) -> None:
        response.findings.extend(item for item in items if isinstance(item, Finding))

    def _read(self, frame: Frame, seconds: float, command: Command) -> ReceivedReply:
        try:
            decoded = frame.decode("reply", of=command.name)
        except ProtocolError as error:
            return ReceivedReply(seconds, frame.data, error)
        message = _typed(command, decoded.fields)
        return ReceivedReply(seconds, frame.data, message=message, decoded=decoded)


def _typed(command: Command, fields: Mapping[str, Any]) -> Reply[Any]:
    assert command.reply_type is not None, "only a command with a reply is waited for"
    return command.reply_type.from_fields(fields)


def _first_line(text: bytes) -> tuple[bytes, bytes]:
    """Return a text up to the end of its line, and what follows."""
    ends = [at for at in map(text.find, (b"\n", b"\xff", b"\xfe")) if at >= 0]
    at = min(ends, default=len(text))
    end = at + 1 if text[at : at + 1] == b"\n" else at
    return text[:end], text[end:]
