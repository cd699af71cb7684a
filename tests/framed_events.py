"""Cut a stream into events, and compare events however the stream was cut."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.codec.interface import Codec, Event, Listening, Noise


def cut(codec: Codec, listening: Listening, chunks: Sequence[bytes]) -> list[Event]:
    """Return all events of a stream that arrives in these chunks and then falls silent."""
    framer = codec.framer(listening)
    events = [event for chunk in chunks for event in framer.feed(chunk)]
    return events + framer.flush()


def joined(events: Sequence[Event]) -> list[Event]:
    """Return the events with adjacent noise of one reason joined to one span."""
    found: list[Event] = []
    for event in events:
        last = found[-1] if found else None
        if isinstance(event, Noise) and isinstance(last, Noise) and last.reason == event.reason:
            found[-1] = Noise(last.offset, last.data + event.data, last.reason)
        else:
            found.append(event)
    return found
