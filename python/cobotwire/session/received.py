"""What was received while a reply was waited for, in words."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from cobotwire.codec.interface import Codec, Event, Noise
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.lazy import import_aside
from cobotwire.protocol.table import Command
from cobotwire.session.events import AckReceived, EchoReceived, EventReceived, FrameEvent, LateReply

# At most this many lines are kept, and this many bytes of each are shown.
LINES = 20
SHOWN = 24
# At most this much of a span of noise is kept for its diagnosis: a panic dump has about 2.4 kB.
KEPT = 4096


class _NoiseSpan:
    """Adjacent noise, with the reason of its first byte."""

    __slots__ = ("data", "offset", "reason", "size")

    def __init__(self, first: Noise) -> None:
        self.offset, self.reason = first.offset, first.reason
        self.data = bytearray()
        self.size = 0

    def add(self, data: bytes) -> None:
        self.data += data[: KEPT - len(self.data)]
        self.size += len(data)


_Item = FrameEvent | _NoiseSpan


class ReceivedMeanwhile:
    """The last frames and spans of noise, for the text of a ReplyTimeout.

    Noise is diagnosed only when the text is made, so it costs nothing if the reply comes.
    """

    __slots__ = ("_items",)

    def __init__(self) -> None:
        self._items: deque[_Item] = deque(maxlen=LINES)

    def add(self, event: FrameEvent | Noise) -> None:
        """Note one event. Adjacent spans of noise become one."""
        if not isinstance(event, Noise):
            self._items.append(event)
            return
        last = self._items[-1] if self._items else None
        if not isinstance(last, _NoiseSpan):
            last = _NoiseSpan(event)
            self._items.append(last)
        last.add(event.data)

    def lines(self, codec: Codec, request: bytes, command: Command) -> tuple[str, ...]:
        """Return a line for each item, oldest first.

        ``request`` are bytes the line may echo; ``command`` is the one that was called.
        """
        diagnoses = _diagnoses(self._items, codec, request, command)
        return tuple(
            _noise_line(item, next(diagnoses))
            if isinstance(item, _NoiseSpan)
            else _frame_line(item, command.id)
            for item in self._items
        )


def _diagnoses(
    items: deque[_Item], codec: Codec, request: bytes, command: Command
) -> Iterator[str]:
    """Yield a diagnosis for each span, as a sentence; empty if nothing is recognised in it."""
    # Imported here: most programs never need it.
    import_aside(
        "cobotwire.diagnose", "DamagedFrame", "Diagnoser", "Finding", "Summary", "Unrecognised"
    )
    from cobotwire.diagnose import DamagedFrame, Diagnoser, Finding, Summary, Unrecognised

    diagnoser = Diagnoser(codec, "reply")
    diagnoser.sent(request)
    found = [*diagnoser.feed(_as_events(items)), *diagnoser.flush()]
    findings = [i for i in found if isinstance(i, Finding) and not isinstance(i, Unrecognised)]
    # If commands share an id, the text names the one that the user called.
    findings = [
        found.of_command(command.name)
        if isinstance(found, DamagedFrame) and found.id == command.id
        else found
        for found in findings
    ]
    for span in (item for item in items if isinstance(item, _NoiseSpan)):
        end = span.offset + span.size
        yield str(Summary(f for f in findings if span.offset <= f.offset < end))


def _as_events(items: deque[_Item]) -> Iterator[Event]:
    for item in items:
        if isinstance(item, _NoiseSpan):
            yield Noise(item.offset, bytes(item.data), item.reason)
        else:
            yield item.frame


def _noise_line(span: _NoiseSpan, diagnosis: str) -> str:
    kind, data = "diagnosed-noise" if diagnosis else "noise", _hex(span.data, span.size)
    return error_text(kind, reason=span.reason, data=data, diagnosis=diagnosis)


def _frame_line(event: FrameEvent, request_id: int) -> str:
    data = _hex(event.frame.data, len(event.frame.data))
    if isinstance(event, LateReply):
        return error_text("late-reply", command=event.command.name, data=data)
    if isinstance(event, EventReceived):
        return error_text("event", command=event.command.name, data=data)
    if isinstance(event, AckReceived):
        # An acknowledgement has only the command's id, so an earlier request may have caused it.
        kind = "doubtful-ack" if event.frame.command == request_id else "ack"
        return error_text(kind, command=event.command.name, data=data)
    return error_text("echo" if isinstance(event, EchoReceived) else "frame", data=data)


def _hex(data: bytes | bytearray, size: int) -> str:
    shown = data[:SHOWN].hex(" ").upper()
    return error_text("cut-data", data=shown, size=size) if size > SHOWN else shown
