"""Exchanges of Python whose steps are recorded, and their twins in Rust, which must do the same.

The probe plays the steps of all exchanges at once. It answers each with its result, and with what
can be seen of the exchange afterwards: when it is idle until, the outcomes of requests, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from itertools import repeat
from math import inf, isfinite
from types import TracebackType
from typing import Any, NamedTuple, Self
from unittest.mock import patch

from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Noise
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout, RequestRefused
from cobotwire.protocol.table import _word
from cobotwire.session import (
    AckReceived,
    EchoReceived,
    EncodedRequest,
    EventReceived,
    Exchange,
    LateReply,
    Pending,
    PendingAck,
    PendingRequest,
    ReplyMatched,
    ReplyRejected,
    RequestExpired,
    SessionEvent,
    UnexpectedFrame,
    received,
    text,
)
from cobotwire.session.alignment import Alignment
from cobotwire.session.outstanding import PersistedState

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

    def __init__(self, number: int, exchange: Exchange) -> None:
        self.number = number
        self.exchange = exchange
        self.now = 0.0
        self.pending: list[Pending] = []
        self.open: set[int] = set()


class Step(NamedTuple):
    """A step for the probe, the result in Python, and what could be seen afterwards."""

    sent: list[Any]
    result: Any
    seen: Any


class Recorder:
    """Records the steps of every exchange that is made while it is entered."""

    def __init__(self, codec: Codec, edition: str) -> None:
        """Take the codec, and the path of its ``edition.json``."""
        self._codec = codec
        self._edition = edition
        self.steps: list[Step] = []
        self._twins: dict[int, Twin] = {}
        self._indices = {command.name: i for i, command in enumerate(codec.table.commands)}
        self._patches = ExitStack()
        self._inside = False

    def __enter__(self) -> Self:
        wrapped = [(Exchange, name) for name in METHODS] + [(Alignment, "cut"), (Alignment, "end")]
        for owner, name in (*wrapped, (Exchange, "__init__")):
            call = self._recording(name, getattr(owner, name))
            self._patches.enter_context(patch.object(owner, name, call))
        # The diagnosis of noise stays in Python.
        self._patches.enter_context(patch.object(received, "_diagnoses", lambda *_: repeat("")))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: object, trace: TracebackType | None
    ) -> None:
        self._patches.close()

    def check(self, ask: Callable[[Any], Any]) -> list[str]:
        """Have Rust repeat all steps; compare what it does. Return the states that were noted."""
        steps, self.steps = self.steps, []
        states: list[str] = []
        for step, answer in zip(steps, ask([step.sent for step in steps]), strict=True):
            if step.sent[2] == "new":
                assert answer is None, answer
                continue
            assert isinstance(answer, list), (step, answer)
            result, seen = answer
            if step.sent[2] == "state":
                states.append(result)
                continue
            assert step.result == result, (step, answer)
            *seen, ended = seen
            ended = [[ticket, self._outcome_of(outcome)] for ticket, outcome in ended]
            assert step.seen == [*seen, ended], (step, answer)
        return states

    def note_state(self, exchange: Exchange) -> Twin:
        """Have Rust describe the state of an exchange; return its twin."""
        twin = self._twins[id(exchange.alignment)]
        self.steps.append(Step([twin.number, nanos(twin.now), "state"], None, None))
        return twin

    def _recording(self, name: str, original: Callable[..., Any]) -> Callable[..., Any]:
        def call(subject: Any, *arguments: Any, **named: Any) -> Any:
            if self._inside:
                return original(subject, *arguments, **named)
            self._inside = True
            try:
                result = original(subject, *arguments, **named)
                if name == "__init__":
                    self._open(subject)
                else:
                    part = subject.alignment if isinstance(subject, Exchange) else subject
                    self._note(self._twins[id(part)], name, arguments, named, result)
            finally:
                self._inside = False
            return result

        return call

    def _open(self, exchange: Exchange) -> None:
        twin = Twin(len(self._twins), exchange)
        self._twins[id(exchange.alignment)] = twin
        self.steps.append(Step([twin.number, 0, "new", self._edition], None, None))

    def _note(
        self, twin: Twin, name: str, arguments: tuple[Any, ...], named: Any, result: Any
    ) -> None:
        sent: list[Any] = []
        if name == "enqueue":
            [pending] = arguments
            assert isinstance(pending, PendingRequest)
            twin.now = pending.queued_at
            usual = pending._wait == pending.request.command.deadline_ms / 1000
            wait = None if usual else nanos(pending._wait)
            attempts, shortest, grace = pending.policy
            policy = [attempts, nanos(shortest), nanos(grace)]
            sent = [self._request(pending.request), nanos(pending.ends_by), wait, policy]
            self._add(twin, pending)
        elif name == "send_one_way":
            request, twin.now, within, ends_by = (*arguments, *named.values(), inf)[:4]
            within = None if within is None else nanos(within)
            sent = [self._request(request), nanos(ends_by), within]
            data, ack = result
            result = [data.hex(), ack is not None]
            if ack is not None:
                self._add(twin, ack)
        elif name in ("give_up", "written"):
            ticket = next(i for i, p in enumerate(twin.pending) if p is arguments[0])
            sent = [ticket]
            if name == "give_up":
                # It has ended without an outcome, unless the outcome was seen before.
                twin.open.discard(ticket)
            twin.now = arguments[1] if name == "written" else twin.now
        elif name == "restore":
            sent = [_persisted(*arguments)]
        elif name == "cut":
            align, request, written = arguments
            sent = [align.hex(), request.hex(), written]
        elif name == "note_full":
            sent = [*arguments]
        elif name == "outgoing":
            twin.now, drained = [*arguments, *dict(named).values()]
            sent, result = [drained], result.hex()
        elif name in ("advance", "receive"):
            data, twin.now = arguments
            sent, result = [data.hex()], self._events(result)
        elif name != "end" and name != "fail_waiting":
            twin.now = arguments[-1]
            result = _persisted(result) if name == "persist" else self._events(result)
        method = "aligned" if name == "end" else name
        now = nanos(twin.now)
        seen = self._seen(twin)
        self.steps.append(Step([twin.number, now, method, *sent], result, seen))

    def _add(self, twin: Twin, pending: Pending) -> None:
        twin.open.add(len(twin.pending))
        twin.pending.append(pending)

    def _seen(self, twin: Twin) -> list[Any]:
        exchange, now = twin.exchange, twin.now
        idle = exchange.idle_seconds(now)
        last = [i for i, pending in enumerate(twin.pending) if pending is exchange.sent_last]
        ended = [ticket for ticket in sorted(twin.open) if twin.pending[ticket].done]
        twin.open.difference_update(ended)
        return [
            None if idle is None else nanos(idle),
            exchange.busy,
            exchange.has_next(now),
            exchange.alignment.align.hex(),
            last[0] if last else None,
            [[ticket, self._outcome(twin.pending[ticket], now)] for ticket in ended],
        ]

    # What Python has, as the probe writes it.

    def _request(self, request: EncodedRequest) -> dict[str, Any]:
        command = request.command
        message = self._codec.decode("request", request.frame, of=command.name)
        form = command.request_text
        return {
            "command": command.name,
            "values": plain(message.values),
            "texts": list(text.decode(form, request.text).values()) if form else [],
            "address": message.address,
            "variant": command.request.index(message.variant),
        }

    def _events(self, events: Iterable[SessionEvent]) -> list[Any]:
        return [self._event(event) for event in events]

    def _event(self, event: SessionEvent) -> list[Any]:
        if isinstance(event, Noise):
            return ["noise", event.offset, event.reason, event.data.hex()]
        frame = None if isinstance(event, RequestExpired) else _frame(event.frame)
        if isinstance(event, UnexpectedFrame | EchoReceived):
            return ["echo" if isinstance(event, EchoReceived) else "unexpected", frame]
        index = self._indices[event.command.name]
        match event:
            case ReplyMatched(message=message):
                texts = [] if message else [*event.fields.values()]
                reply = None if message is None else self._decoded(message)
                return ["matched", index, reply, texts, frame]
            case ReplyRejected(error=error):
                return ["rejected", index, frame and [error.reason, error.offset], frame]
            case LateReply():
                return ["late", index, frame]
            case AckReceived(message=message):
                return ["ack", index, self._decoded(message), frame]
            case EventReceived(message=message):
                return ["event", index, self._decoded(message), frame]
            case RequestExpired():
                return ["expired", index, nanos(event.requested_at), event.attempts]
        raise AssertionError(event)

    def _decoded(self, message: DecodedMessage) -> list[Any]:
        variant = message.command.reply.index(message.variant)
        index = self._indices[message.command.name]
        return [index, variant, plain(message.values), message.address]

    def _outcome(self, pending: Pending, now: float) -> list[Any]:
        error = pending._error
        if error is None:
            if isinstance(pending, PendingRequest):
                assert pending.replied_at is not None
                times = [nanos(pending.requested_at), nanos(pending.replied_at)]
                return ["answer", plain_fields(pending._fields), times]
            assert isinstance(pending, PendingAck)
            return ["answer", {}, [nanos(pending.ack.sent_at), nanos(now)]]
        match error:
            case LinkError():
                return ["link"]
            case ReplyTimeout():
                waited_for = error.waited_for or None
                waited = nanos(error.waited)
                lines = error.received
                if pending._received is not None and not lines:  # the explorer saves this time
                    request = pending.request
                    lines = _lines(pending._received, self._codec, request.frame, request.command)
                return ["timeout", waited, error.attempts, waited_for, [*lines]]
            case RequestRefused():
                return ["refused", error.field, error.status]
            case ProtocolError():
                return ["reply", error.reason, error.offset, error.data.hex()]
        raise AssertionError(error)

    # What the probe has, as Python would have it.

    def _outcome_of(self, outcome: Any) -> list[Any]:
        if outcome == "link":
            return ["link"]
        [(kind, parts)] = outcome.items()
        commands = self._codec.table.commands
        if kind == "answer":
            reply, texts, times = parts
            if reply is not None:
                index, variant, values, _ = reply
                names: Sequence[str] = commands[index].reply[variant].names
                return [kind, plain_fields(dict(zip(names, values, strict=True))), times]
            return [kind, dict(enumerate(texts)), times]
        if kind == "timeout":
            *head, items = parts
            return [kind, *head, [self._line(*item) for item in items]]
        if kind == "refused":
            index, variant, field, [value] = parts
            field = commands[index].reply[variant].fields[field]
            return [kind, field.name, _word(field, value)]
        (reason, offset), data = parts
        return [kind, reason, offset, data]

    def _line(self, kind: str, index: int | None, detail: Any, shown: str, size: int) -> str:
        name = "" if index is None else self._codec.table.commands[index].name
        rest = f" ... {size} bytes" if size > len(shown) // 2 else ""
        doubt = ", perhaps of an earlier request" if detail is True else ""
        what = {
            "noise": f"noise ({detail})",
            "late": f"late reply to {name}",
            "event": f"event {name}",
            "ack": f"acknowledgement of {name}{doubt}",
            "echo": "the request's own bytes",
            "frame": "frame",
        }
        if kind == "unread":
            return error_text("too-much")
        return f"{what[kind]} {bytes.fromhex(shown).hex(' ').upper()}{rest}"


def plain(value: Any) -> Any:
    """Return a value as the probe reads and writes it."""
    if isinstance(value, tuple | list):
        return [plain(each) for each in value]
    if isinstance(value, bytes):
        return {"bytes": value.hex()}
    if isinstance(value, float) and not isfinite(value):
        return {"real": {inf: "inf", -inf: "-inf"}.get(value, "NaN")}
    return value


def plain_fields(fields: dict[str, Any]) -> dict[Any, Any]:
    """Return the fields of a reply; those of a text by their position."""
    if fields and all(isinstance(value, str) for value in fields.values()):
        return dict(enumerate(fields.values()))
    return {name: plain(value) for name, value in fields.items()}


def _persisted(state: PersistedState) -> list[Any]:
    late = [[each.request.hex(), nanos(each.until)] for each in state.late]
    return [late, [[part.request.hex(), part.written] for part in state.parts]]


def _frame(frame: Frame | None) -> list[Any] | None:
    return None if frame is None else [frame.offset, frame.data.hex()]
