"""What was heard while an answer was waited for, in words."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from cobotwire.codec.interface import Codec, Event, Frame, Noise
from cobotwire.session.events import Echoed, Late, Unasked

# However much a line brings: so many lines are kept, and so many bytes of each are shown.
LINES = 20
SHOWN = 24
# So many bytes of a span of noise are kept, to say what they are: a panic dump has about 2.4 kB.
KEPT = 4096


class _Span:
    """Adjacent noise, with the reason of its first byte."""

    __slots__ = ("data", "offset", "reason", "size")

    def __init__(self, first: Noise) -> None:
        self.offset, self.reason = first.offset, first.reason
        self.data = bytearray()
        self.size = 0

    def add(self, data: bytes) -> None:
        self.data += data[: KEPT - len(self.data)]
        self.size += len(data)


class Heard:
    """Frames and spans of noise; the last of them, if they are many.

    What a :class:`cobotwire.errors.ReplyTimeout` says of the line is made here and nowhere else.
    What noise is, is asked when that is said: a call that is answered does not pay for it.
    """

    __slots__ = ("_events",)

    def __init__(self) -> None:
        self._events: deque[Unasked | Late | Echoed | _Span] = deque(maxlen=LINES)

    def add(self, event: Unasked | Late | Echoed | Noise) -> None:
        """Note one event. Adjacent spans of noise are one."""
        if not isinstance(event, Noise):
            self._events.append(event)
            return
        if not self._events or not isinstance(self._events[-1], _Span):
            self._events.append(_Span(event))
        last = self._events[-1]
        assert isinstance(last, _Span), "it is one, or was made just now"
        last.add(event.data)

    def lines(self, codec: Codec, asked: bytes) -> tuple[str, ...]:
        """All of it, oldest first; ``asked`` is the request, which a line may echo."""
        if not self._events:
            return ()
        says = _diagnoses(self._events, codec, asked)
        return tuple(
            _noise(event, next(says)) if isinstance(event, _Span) else _frame(event)
            for event in self._events
        )


def _diagnoses(
    events: deque[Unasked | Late | Echoed | _Span], codec: Codec, asked: bytes
) -> Iterator[str]:
    """For each span what begins in it, in a sentence; empty where nothing can be said."""
    # Here, not above: most programs never need it, and each would wait for its import.
    from cobotwire.diagnose import Diagnoser, Finding, Summary, Unrecognised

    diagnoser = Diagnoser(codec, "reply")
    diagnoser.sent(asked)
    items = [*diagnoser.feed(_replayed(events)), *diagnoser.flush()]
    findings = [i for i in items if isinstance(i, Finding) and not isinstance(i, Unrecognised)]
    for span in (event for event in events if isinstance(event, _Span)):
        end = span.offset + span.size
        yield str(Summary(f for f in findings if span.offset <= f.offset < end))


def _replayed(events: deque[Unasked | Late | Echoed | _Span]) -> Iterator[Event]:
    for event in events:
        if isinstance(event, _Span):
            yield Noise(event.offset, bytes(event.data), event.reason)
        else:
            yield event.frame


def _noise(span: _Span, said: str) -> str:
    line = f"noise ({span.reason}) {_shown(span.data, span.size)}"
    return f"{line}: {said}" if said else line


def _frame(event: Unasked | Late | Echoed) -> str:
    frame: Frame = event.frame
    return f"{_kind(event)} {_shown(frame.data, len(frame.data))}"


def _kind(event: Unasked | Late | Echoed) -> str:
    if isinstance(event, Late):
        return f"late reply to {event.command.name}"
    return "the question's own bytes" if isinstance(event, Echoed) else "frame"


def _shown(data: bytes | bytearray, size: int) -> str:
    rest = f" ... {size} bytes" if size > SHOWN else ""
    return data[:SHOWN].hex(" ").upper() + rest
