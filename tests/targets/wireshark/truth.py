"""What the Python framer says of a line, in the form in which dissected packets are joined."""

from __future__ import annotations

from collections.abc import Iterable

from cobotwire.codec.interface import Codec, Event, Frame, Listening

# The events so far, and how many bytes wait.
Truth = tuple[list[Event], int]


def events_of(codec: Codec, direction: Listening, chunks: Iterable[tuple[bytes, bool]]) -> Truth:
    """The events of chunks, each with whether the line is silent behind it; what waits, waits."""
    framer = codec.framer(direction)
    events: list[Event] = []
    for data, silent in chunks:
        events += framer.feed(data)
        if silent:
            events += framer.flush()
    return events, framer.pending


def told(truth: Truth, data: bytes) -> list[tuple[str, bytes]]:
    """Kinds and bytes, adjacent noise of one reason joined, and at the end what waits."""
    events, pending = truth
    found: list[tuple[str, bytes]] = []
    for event in events:
        kind = "frame" if isinstance(event, Frame) else event.reason
        if found and found[-1][0] == kind != "frame":
            found[-1] = kind, found[-1][1] + event.data
        else:
            found.append((kind, event.data))
    return [*found, ("incomplete", data[-pending:])] if pending else found
