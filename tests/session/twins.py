"""Exchanges of Python whose steps are recorded, and their twins in Rust, which must do the same.

The probe plays the steps of all exchanges at once. For each step it returns the result
and the visible state afterwards: until when the exchange is idle, outcomes, and so on.
Messages and errors are compared by their texts.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack
from importlib import import_module
from inspect import signature
from itertools import repeat
from math import inf, isfinite
from pathlib import Path
from typing import Any, Self
from unittest.mock import patch

from cobotwire.codec.interface import Codec, Noise
from cobotwire.protocol.addresses import address_name
from cobotwire.protocol.errors import LinkError, ReplyTimeout, UsageError
from cobotwire.protocol.table import Command, Table
from cobotwire.session import (
    EncodedRequest,
    Exchange,
    Pending,
    PendingAck,
    PendingRequest,
    ReplyMatched,
    RequestExpired,
    SessionEvent,
    received,
    text,
)
from cobotwire.session.alignment import Alignment
from cobotwire.session.events import as_traffic
from cobotwire.session.request import RequestEncoder

METHODS = (
    *("enqueue", "send_one_way", "give_up", "fail", "fail_waiting", "persist", "restore"),
    *("advance", "receive", "wake", "end_overdue", "note_full", "outgoing", "written"),
)
_lines = received.ReceivedMeanwhile.lines
# Thirds and twentieths of a second are no whole nanoseconds.
NEAR = 2


class Near(int):
    """A time that Rust may round in another way."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, int) and abs(int(self) - int(other)) <= NEAR

    __hash__ = int.__hash__


def nanos(seconds: float) -> Near | None:
    """Return seconds as nanoseconds; None: never."""
    return Near(round(seconds * 1e9)) if seconds < inf else None


class Twin:
    """One exchange of Python, with its requests in the order of their tickets."""

    def __init__(self, edition: str, number: int, exchange: Exchange) -> None:
        self.edition = edition
        self.number = number
        self.exchange = exchange
        self.codec = exchange._codec
        self.now = 0.0
        self.pending: list[Pending] = []
        self.open: set[int] = set()

    def ticket(self, pending: Pending) -> int:
        """Return the number of a request's ticket; a new request gets the next one."""
        known = (i for i, other in enumerate(self.pending) if other is pending)
        ticket = next(known, len(self.pending))
        if ticket == len(self.pending):
            self.open.add(ticket)
            self.pending.append(pending)
        return ticket


class Recorder(ExitStack):
    """Records the steps of every exchange that is made while it is entered."""

    def __init__(self, edition: str = "") -> None:
        """Take the path of the ``edition.json`` of all exchanges, or record known editions."""
        super().__init__()
        self._edition = edition
        # Steps for the probe; results in Python with what could be seen afterwards.
        self._steps: list[tuple[list[Any], Any]] = []
        self._twins: dict[int, Twin] = {}
        self._inside = False

    def __enter__(self) -> Self:
        wrapped = [(Exchange, name) for name in METHODS] + [(Alignment, "cut"), (Alignment, "end")]
        for owner, name in (*wrapped, (Exchange, "__init__"), (RequestEncoder, "encode")):
            call = self._recording(name, getattr(owner, name))
            self.enter_context(patch.object(owner, name, call))
        # The diagnosis of noise stays in Python.
        self.enter_context(patch.object(received, "_diagnoses", lambda *_: repeat("")))
        return self

    def check(self, ask: Callable[[Any], Any]) -> list[str]:
        """Have Rust repeat all steps; compare what it does. Return the states that were noted."""
        twins = [self.note_state(twin.exchange) for twin in self._twins.values()]
        steps, self._steps = self._steps, []
        states: list[str] = []
        for (sent, result), answer in zip(steps, ask([sent for sent, _ in steps]), strict=True):
            if sent[0] == "state":
                states.append(answer)
            else:
                assert result == answer, (sent, result, answer)
        for twin, state in zip(reversed(twins), iter(states.pop, None)):
            count = len(twin.exchange._outstanding.replies)
            assert state.count("OutstandingReply {") == count, "replies that it still expects"
        return states

    def note_state(self, exchange: Exchange) -> Twin:
        """Have Rust describe the state of an exchange; return its twin."""
        twin = self._twins[id(exchange.alignment)]
        self._send(twin, "state", [], None)
        return twin

    def _send(self, twin: Twin, method: str, given: list[Any], result: Any) -> None:
        sent = [method, twin.edition, twin.number, nanos(twin.now), *given]
        self._steps.append((sent, result))

    def _recording(self, name: str, original: Callable[..., Any]) -> Callable[..., Any]:
        parameters = signature(original)

        def call(subject: Any, *arguments: Any, **named: Any) -> Any:
            if self._inside:
                return original(subject, *arguments, **named)
            bound = parameters.bind(subject, *arguments, **named)
            bound.apply_defaults()
            _, *given = bound.arguments.items()
            self._inside = True
            try:
                result = original(subject, *arguments, **named)
                if name == "__init__":
                    self._note_new(subject)
                elif name != "encode":
                    part = subject.alignment if isinstance(subject, Exchange) else subject
                    if twin := self._twins.get(id(part)):
                        self._note(twin, name, dict(given), result)
            except UsageError as error:
                self._note_refusal(subject, dict(given), error)
                raise
            finally:
                self._inside = False
            return result

        return call

    def _note_new(self, exchange: Exchange) -> None:
        if path := self._edition or _path_of(exchange._codec.table):
            twin = Twin(path, len(self._twins), exchange)
            self._twins[id(exchange.alignment)] = twin
            self._steps.append((["new", path, twin.number], None))

    def _note(self, twin: Twin, name: str, given: dict[str, Any], result: Any) -> None:
        pending = given.get("pending")
        twin.now = given.pop("now", twin.now)
        if name == "enqueue":
            assert isinstance(pending, PendingRequest)
            twin.now = pending.queued_at
            usual = pending._wait == pending.request.command.deadline_ms / 1000
            wait = None if usual else pending._wait
            given["pending"] = pending.request, wait, pending.policy, pending.ends_by
            twin.ticket(pending)
        elif name == "give_up":
            # The request has ended without an outcome, unless the outcome was seen before.
            twin.open.discard(twin.ticket(given["pending"]))
        sent = [self._plain(twin, value) for value in given.values()]
        result = self._plain(twin, result)
        self._send(twin, name, sent, [result, self._seen(twin)])

    def _note_refusal(
        self, encoder: RequestEncoder, given: dict[str, Any], error: UsageError
    ) -> None:
        """Have Rust refuse a request in the same words."""
        name, values, texts, variant = given.values()
        request = [name, plain(values), [*(texts or {}).values()], encoder._address, variant]
        for twin in self._twins.values():
            if twin.codec.table is encoder._codec.table:
                self._send(twin, "prepare", [request], [str(error), self._seen(twin)])
                break

    def _seen(self, twin: Twin) -> list[Any]:
        exchange, now = twin.exchange, twin.now
        last = exchange.sent_last
        ended = [ticket for ticket in sorted(twin.open) if twin.pending[ticket].done]
        twin.open.difference_update(ended)
        return [
            self._plain(twin, exchange.idle_seconds(now)),
            exchange.alignment.align.hex(),
            None if last is None else twin.ticket(last),
            [[ticket, self._outcome(twin, twin.pending[ticket])] for ticket in ended],
        ]

    def _outcome(self, twin: Twin, pending: Pending) -> list[Any]:
        error = pending._error
        if error is None:
            if isinstance(pending, PendingRequest):
                assert pending.replied_at is not None
                times = [nanos(pending.requested_at), nanos(pending.replied_at)]
            else:
                assert isinstance(pending, PendingAck)
                times = [nanos(pending.ack.sent_at), nanos(twin.now)]
            return ["answer", _fields(pending._fields), times]
        if not isinstance(error, ReplyTimeout):
            text = None if isinstance(error, LinkError) else str(error)
            return [type(error).__name__, text, None]
        if pending._received is not None and not error.received:  # the explorer saves this time
            request = pending.request
            lines = _lines(pending._received, twin.codec, request.frame, request.command)
            why = error.waited_for or None
            sent = error.attempts, error.request
            error = ReplyTimeout(error.command, error.waited, lines, *sent, why)
        return [type(error).__name__, str(error), nanos(error.waited)]

    def _plain(self, twin: Twin, value: Any) -> Any:
        """Return a value as the probe reads and writes it."""
        match value:
            case float():
                return nanos(value)
            case bytes():
                return value.hex()
            case Command():
                return value.name
            case EncodedRequest():
                return _request(twin.codec, value)
            case Pending():
                return twin.ticket(value)
            case LinkError():
                return None
            case _ if isinstance(value, SessionEvent):
                return _event(twin, value)
            case tuple() | list():
                return [self._plain(twin, each) for each in value]
        return value


def _event(twin: Twin, event: SessionEvent) -> list[Any]:
    """Return the name of an event in Rust, its command, what it says, and its bytes."""
    command, message = (getattr(event, name, None) for name in ("command", "message"))
    says: Any = None
    if message is not None:
        address = message.address
        to = "" if address is None else f" to {address_name(twin.codec.table, address)}"
        says = f"{message.command.name}({_fields(message.fields)}){to}"
    elif isinstance(event, ReplyMatched):
        says = [*event.fields.values()]
    elif isinstance(event, Noise):
        says = event.reason
    elif isinstance(event, RequestExpired):
        says = [nanos(event.requested_at), event.attempts]
    traffic = as_traffic(event, 0.0)
    name = re.sub("Reply|Received|Frame|Request", "", type(event).__name__)
    return [name, command and command.name, says, traffic.data.hex() if traffic else ""]


def _path_of(table: Table) -> str:
    """Return the path of the ``edition.json`` of a table; empty if it has none."""
    name = table.commands[0].package
    if not name or table != (package := import_module(name)).TABLE:
        return ""
    return str(Path(str(package.__file__)).with_name("edition.json"))


def _request(codec: Codec, request: EncodedRequest) -> list[Any]:
    command, form = request.command, request.command.request_text
    message = codec.decode("request", request.frame, of=command.name)
    texts = [*text.decode(form, request.text).values()] if form else []
    variant = command.request.index(message.variant)
    return [command.name, plain(message.values), texts, message.address, variant]


def _fields(fields: dict[str, Any]) -> str:
    return ", ".join(f"{name}={value}" for name, value in fields.items())


def plain(value: Any) -> Any:
    """Return a value of a caller as the probe reads it."""
    if isinstance(value, tuple | list):
        return [plain(each) for each in value]
    if isinstance(value, bytes):
        return {"bytes": value.hex()}
    if value is ...:
        return {"count": True}
    if isinstance(value, float) and not isfinite(value):
        return {"real": str(value)}
    return value
