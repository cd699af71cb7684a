"""Asks over the line, and sorts what comes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.conformance.device.hearing import Hearing, Reply
from cobotwire.conformance.device.line import Line
from cobotwire.diagnose import Diagnoser, Finding
from cobotwire.errors import ProtocolError
from cobotwire.session.listening import TextListener
from cobotwire.session.request import Request, Requests, in_words
from cobotwire.table import Command


@dataclass(frozen=True, slots=True)
class Waits:
    """How long is listened, in seconds.

    ``linger`` behind a reply, for a second one; ``silence`` where nothing is due; ``grace`` behind
    a deadline, for late replies (727 ms were seen); ``idle`` until an arm gives up half a request;
    ``pause`` between the pieces of a request.
    """

    linger: float = 0.004
    silence: float = 0.03
    grace: float = 0.3
    idle: float = 0.25
    pause: float = 0.01


class Asker:
    """One line, one edition: sends requests and gives what was heard of each."""

    def __init__(self, line: Line, codec: Codec, waits: Waits) -> None:
        self.line = line
        self.codec = codec
        self.waits = waits
        self._requests = Requests(codec)
        self._framer = codec.framer("reply")
        self._diagnoser = Diagnoser(codec)

    def request(
        self, command: Command, values: Sequence[Any], text: Mapping[str, str] | None = None
    ) -> Request:
        """A request, checked and spelt.

        Raises:
            UsageError: the edition does not allow the arguments.
        """
        return self._requests.prepare(command.name, values, text)

    def ask(self, request: Request) -> Hearing:
        """Send a request, and listen until its answer has come or cannot come any more."""
        return self.exchange(request, request.frame, in_words(request, self.codec))

    def exchange(self, request: Request, sent: bytes, note: str) -> Hearing:
        """Send ``sent`` in place of a request, and listen as if for its answer."""
        self.line.send(sent, note)
        if request.text:
            self.line.send(request.text, "the text behind it")
        began = self.line.now
        hearing = Hearing(request)
        if request.command.text is not None:
            self._hear_text(hearing, began)
        elif request.command.answers:
            self._hear_reply(hearing, began)
        self.quiet(hearing, began, self._tail(hearing))
        return hearing

    def told(self, request: Request, sent: bytes, note: str, seconds: float) -> Hearing:
        """Send what needs no answer, and hear what comes within ``seconds``."""
        self.line.send(sent, note)
        hearing = Hearing(request)
        self.quiet(hearing, self.line.now, seconds)
        return hearing

    def quiet(self, hearing: Hearing, began: float, seconds: float) -> None:
        """Listen until nothing has come for ``seconds``, and decide what it all was."""
        most = self.line.now + max(self.waits.grace, 4 * seconds)
        while self.line.now < most and (data := self.line.hear(seconds)):
            self._sort(hearing, self._framer.feed(data), began)
        self._sort(hearing, self._framer.flush(), began)
        self._keep(hearing, self._diagnoser.flush())

    def _tail(self, hearing: Hearing) -> float:
        """How long to listen behind an answer; or for one that is late, or was never due."""
        if hearing.replies:
            return self.waits.linger
        return self.waits.grace if hearing.request.command.answers else self.waits.silence

    def _hear_reply(self, hearing: Hearing, began: float) -> None:
        until = began + hearing.request.command.deadline_ms / 1000
        while not hearing.replies and (left := until - self.line.now) > 0:
            self._sort(hearing, self._framer.feed(self.line.hear(left)), began)

    def _hear_text(self, hearing: Hearing, began: float) -> None:
        """Text has no frame: what no packet explains is it, until the line is silent."""
        form = hearing.request.command.text
        assert form is not None
        until = began + hearing.request.command.deadline_ms / 1000
        heard = b""
        first = 0.0
        while data := self.line.hear((form.silence_ms / 1000) if heard else until - self.line.now):
            first = first or self.line.now - began
            heard += data
        self._read_text(hearing, heard, first)

    def _read_text(self, hearing: Hearing, heard: bytes, seconds: float) -> None:
        """Find the text among what was heard; the rest is frames and noise like any other."""
        form = hearing.request.command.text
        assert form is not None
        start = heard.find(form.prefixes[0].encode("ascii"))
        if start < 0:
            self._sort(hearing, self._framer.feed(heard), self.line.now)
            return
        text, rest = _first_line(heard[start:])
        listener = TextListener(form)
        listener.hear(text, 0.0)
        try:
            reply = Reply(seconds, text, None, None, listener.read())
        except ProtocolError as error:
            reply = Reply(seconds, text, None, error, {})
        hearing.replies.append(reply)
        self._sort(hearing, self._framer.feed(heard[:start] + rest), self.line.now)

    def _sort(self, hearing: Hearing, events: list[Event], began: float) -> None:
        """Frames at once; what noise is shows later."""
        for event in events:
            if isinstance(event, Frame):
                self._take(hearing, event, self.line.now - began)
        self._keep(hearing, self._diagnoser.feed(events))

    def _take(self, hearing: Hearing, frame: Frame, seconds: float) -> None:
        command = hearing.request.command
        if frame.command == command.id and command.reply:
            hearing.replies.append(self._read(frame, command, seconds))
        else:
            hearing.others.append(frame)

    def _keep(self, hearing: Hearing, items: Sequence[Frame | Finding]) -> None:
        hearing.findings.extend(item for item in items if isinstance(item, Finding))

    def _read(self, frame: Frame, command: Command, seconds: float) -> Reply:
        try:
            message = self.codec.decode("reply", frame.data, of=command.name)
        except ProtocolError as error:
            return Reply(seconds, frame.data, None, error, {})
        return Reply(seconds, frame.data, message, None, message.fields)


def _first_line(text: bytes) -> tuple[bytes, bytes]:
    """A text to the end of its line, and what stands behind it."""
    ends = [at for at in (text.find(b"\n"), text.find(b"\xff"), text.find(b"\xfe")) if at >= 0]
    at = min(ends, default=len(text))
    return (
        (text[: at + 1], text[at + 1 :]) if text[at : at + 1] == b"\n" else (text[:at], text[at:])
    )
