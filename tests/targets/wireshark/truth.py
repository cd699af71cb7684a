"""The Python framer's events of a line, as ``dissecting.joined`` represents them."""

from __future__ import annotations

from collections.abc import Iterable

from cobotwire.codec.interface import Codec, Event, Frame, Listening

# The events so far, and the number of bytes that wait.
Truth = tuple[list[Event], int]


def events_of(codec: Codec, direction: Listening, chunks: Iterable[tuple[bytes, bool]]) -> Truth:
    """Return the events of chunks, each given with whether silence follows it."""
    framer = codec.framer(direction)
    events: list[Event] = []
    for data, silent in chunks:
        events += framer.feed(data)
        if silent:
            events += framer.flush()
    return events, framer.pending


def summary(truth: Truth, data: bytes) -> list[tuple[str, bytes]]:
    """Return kinds and bytes, with adjacent noise of one reason joined and waiting bytes last."""
    events, pending = truth
    found: list[tuple[str, bytes]] = []
    for event in events:
        kind = "frame" if isinstance(event, Frame) else event.reason
        if found and found[-1][0] == kind != "frame":
            found[-1] = kind, found[-1][1] + event.data
        else:
            found.append((kind, event.data))
    return [*found, ("incomplete", data[-pending:])] if pending else found
