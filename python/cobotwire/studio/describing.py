"""Describe entries for the pages: a line of text each, and the samples that curves and arm show.

Each is written as JSON once, however many pages watch.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.diagnose.explain import FrameReader, format_message
from cobotwire.protocol.errors import ProtocolError
from cobotwire.studio.entries import Entry
from cobotwire.studio.samples import Sampler

# At most this many bytes of an entry are in the list; its explanation has all.
SHOWN_BYTES = 64
SHOWN_TEXT = 400


class Described(NamedTuple):
    """An entry as the pages get it, in JSON, and the samples that it holds."""

    entry: str
    samples: tuple[str, ...]


class Describer:
    """Describes the entries of one line in their order."""

    def __init__(self, codec: Codec) -> None:
        self._readers = {
            "sent": FrameReader(codec, ("request",)),
            "received": FrameReader(codec, ("reply",)),
            "unknown": FrameReader(codec),
        }
        self._codec = codec
        self._sampler = Sampler(codec.table)

    def restart(self) -> None:
        """Forget the requests and targets before a jump in time."""
        self._sampler = Sampler(self._codec.table)

    def describe(self, number: int, entry: Entry) -> Described:
        """Return an entry and its samples as JSON; ``number`` identifies it."""
        message, error = self.read(entry)
        samples = self._sampler.take(entry, message)
        written = _written(number, entry, message, error)
        return Described(_json(written), tuple(map(_json, samples)))

    def samples(self, entries: Iterable[Entry]) -> list[str]:
        """Return the samples of entries that come before those that are shown."""
        return [
            _json(sample)
            for entry in entries
            for sample in self._sampler.take(entry, self.read(entry)[0])
        ]

    def read(self, entry: Entry) -> tuple[DecodedMessage | None, ProtocolError | None]:
        """Return the message of an entry, or why its frame has none; both None for others."""
        if entry.finding is not None or not entry.data:
            return None, None
        readings = self._readers[entry.direction].read(frame_of(self._codec, entry))
        return (readings[0].message, readings[0].error) if readings else (None, None)


def frame_of(codec: Codec, entry: Entry) -> bytes:
    """Return the frame of an entry without the text that follows some requests."""
    frame = codec.table.frame
    if not entry.data.startswith(frame.header) or len(entry.data) < frame.head_size:
        return entry.data
    return entry.data[: frame.overhead + frame.read_length(entry.data)]


def _written(
    number: int, entry: Entry, message: DecodedMessage | None, error: ProtocolError | None
) -> dict[str, Any]:
    written: dict[str, Any] = {
        "n": number,
        "t": round(entry.time, 6),
        "d": entry.direction,
        "h": entry.data[:SHOWN_BYTES].hex(" ").upper(),
    }
    if len(entry.data) > SHOWN_BYTES:
        written["size"] = len(entry.data)
    if not entry.data:
        return written | {"k": "remark", "l": entry.label, "x": entry.remark[:SHOWN_TEXT]}
    if entry.finding is not None:
        return written | {
            "k": "noise",
            "l": entry.finding.kind,
            "x": entry.finding.describe()[:SHOWN_TEXT],
        }
    if message is None and entry.direction == "sent":
        what = "no request of the edition, such as fill bytes that end a request that was cut"
        return written | {"k": "noise", "l": "fill", "x": what}
    if message is None:
        what = "not a frame of the edition" if error is None else str(error)
        return written | {"k": "noise", "l": "illegal", "x": what[:SHOWN_TEXT]}
    return written | {
        "k": "frame",
        "l": message.command.name,
        "x": format_message(message)[:SHOWN_TEXT],
        "s": message.command.safety,
    }


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False)
