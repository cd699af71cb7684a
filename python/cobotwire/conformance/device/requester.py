"""Sends requests to the device and sorts what comes back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
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
from cobotwire.session.matching import can_come_from
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


class Requester:
    """Sends requests of one edition on one connection, and returns what came after each."""

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
        self._event_ids = {each.id for each in codec.table.commands if each.event}
        # Most requests are repeated, so each is described once.
        self._descriptions: dict[tuple[str, bytes], str] = {}
        # The last two requests, of different commands, that had a reply.
        self._replied: list[EncodedRequest] = []

    def prepare(self, request: Request[Any]) -> EncodedRequest:
        """Validate and encode a request.

        Raises:
            UsageError: the edition does not allow the arguments.
        """
        return self._requests.encode_request(request)

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
        self._connection.send(data, note)
        if request.text:
            self._connection.send(request.text, "the text of the request")
        start = self._connection.now
        response = self._begin(request)
        if request.command.text is not None:
            self._await_text(response, request.command.text, start)
        elif request.command.requires_reply:
            self._await_reply(response, start, request.command.deadline_ms / 1000)
        elif request.command.ack:
            self._await_reply(response, start, self._timing.silence)
        self.listen(response, start, self._after(response))
        return response

    def send_bytes(
        self, request: EncodedRequest, data: bytes, note: str, seconds: float
    ) -> Response:
        """Send ``data``, to which no reply is due, and listen for ``seconds``."""
        self._connection.send(data, note)
        response = self._begin(request)
        self.listen(response, self._connection.now, seconds)
        return response

    def _begin(self, request: EncodedRequest) -> Response:
        """Return an empty response, which knows the last request of another command."""
        others = [each for each in self._replied if each.command.id != request.command.id]
        return Response(request, others[-1] if others else None)

    def listen(self, response: Response, start: float, seconds: float) -> None:
        """Listen until nothing has come for ``seconds``, and classify all that came."""
        end = self._connection.now + max(self._timing.grace, 4 * seconds)
        while self._connection.now < end and (data := self._connection.receive(seconds)):
            self._sort(response, self._framer.feed(data), start)
        self._sort(response, self._framer.flush(), start)
        self._keep(response, self._diagnoser.flush())

    def _after(self, response: Response) -> float:
        """Return how long to listen for a second reply, a late one, or one that is not due."""
        command = response.request.command
        if command.requires_reply and not response.replies:
            return self._timing.grace
        # Without an acknowledgement, the silence is over by now.
        waited = bool(response.replies) or command.ack
        return self._timing.linger if waited else self._timing.silence

    def _await_reply(self, response: Response, start: float, seconds: float) -> None:
        end = start + seconds
        while not response.replies and (left := end - self._connection.now) > 0:
            self._sort(response, self._framer.feed(self._connection.receive(left)), start)

    def _await_text(self, response: Response, variant: TextReply, start: float) -> None:
        """Receive until the line is silent: text has no frame that would end it."""
        end = start + response.request.command.deadline_ms / 1000
        received, first = b"", 0.0
        while data := self._connection.receive(
            variant.silence_ms / 1000 if received else end - self._connection.now
        ):
            first = first or self._connection.now - start
            received += data
        self._read_text(response, variant, received, first)

    def _read_text(
        self, response: Response, variant: TextReply, received: bytes, seconds: float
    ) -> None:
        """Find the text in what was received; the rest is frames and noise like any other."""
        begins = received.find(variant.prefixes[0].encode("ascii"))
        if begins < 0:
            self._sort(response, self._framer.feed(received), self._connection.now)
            return
        text, rest = _first_line(received[begins:])
        collector = TextCollector(variant)
        collector.add(text, 0.0)
        try:
            message = _typed(response.request.command, collector.decode())
            response.replies.append(ReceivedReply(seconds, text, message=message))
        except ProtocolError as error:
            response.replies.append(ReceivedReply(seconds, text, error))
        others = self._framer.feed(received[:begins] + rest)
        self._sort(response, others, self._connection.now)

    def _sort(self, response: Response, events: list[Event], start: float) -> None:
        """Keep frames at once, and feed all events to the diagnoser: noise may need later bytes."""
        request = response.request
        command = request.command
        for event in events:
            if not isinstance(event, Frame):
                continue
            address = self._codec.table.frame.address(event.data)
            own = request.can_have_reply(event) and self._can_come_from(address, request)
            if self._is_event(event):
                continue
            if own and command.reply:
                self._replied = [e for e in self._replied if e.command is not command][-1:]
                self._replied.append(request)
                response.replies.append(self._read(event, self._connection.now - start, command))
            else:
                response.others.append(event)
        self._keep(response, self._diagnoser.feed(events))

    def _can_come_from(self, address: int | None, request: EncodedRequest) -> bool:
        """Return whether a reply of an address can belong to a request.

        To a request to several devices any of them may reply, if it has the joints.
        """
        device = self._devices.get(address)
        lacks = lacks_joints(self._codec.table, device, request.command)
        return can_come_from(address, request) and not lacks

    def _is_event(self, frame: Frame) -> bool:
        """Return whether a frame is a legal event: the device may send it at any time."""
        if frame.command not in self._event_ids:
            return False
        for command in self._codec.table.commands:
            if command.event and command.id == frame.command:
                with suppress(ProtocolError):
                    frame.decode("reply", of=command.name)
                    return True
        return False

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
