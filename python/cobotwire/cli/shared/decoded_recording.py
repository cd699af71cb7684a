"""Decode a recording, and print it with times."""

from __future__ import annotations

import json

from cobotwire.capture import CaptureReader
from cobotwire.capture.streams import DirectionStream
from cobotwire.cli.shared.item_formats import as_object
from cobotwire.cli.shared.recordings import ARROWS, seconds_column, warn_if_incomplete
from cobotwire.cli.shared.stream_printer import DecodeOptions, StreamPrinter
from cobotwire.diagnose import Item
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.inspect.captured import diagnose_capture


class _TimedStreamPrinter(StreamPrinter):
    """Prints the time and direction of each item of a recorded stream."""

    def __init__(
        self,
        stream: DirectionStream,
        capture: CaptureReader,
        start_ns: int,
        options: DecodeOptions,
        counts: StreamCounts,
    ) -> None:
        super().__init__(stream.codec, stream.listening, options, counts)
        counts.framers.append(stream.framer)
        self._stream, self._start_ns = stream, start_ns
        self._timed = capture.timed
        self._url = capture.interfaces[stream.interface].url
        several = len(capture.interfaces) > 1
        self._label = f" interface {stream.interface}" if several else ""

    def format(self, item: Item) -> str:
        time_ns = self._stream.time_of(item.offset) if self._timed else None
        after = None if time_ns is None else (time_ns - self._start_ns) / 1e9
        direction = self._stream.direction
        if not self._options.as_json:
            return (
                f"{seconds_column(after)}{self._label} {ARROWS[direction]} {super().format(item)}"
            )
        facts = {"time_ns": time_ns, "after": after, "url": self._url, "direction": direction}
        return json.dumps({**self._file, **facts, **as_object(self.reader, item)})


def decode_recording(capture: CaptureReader, options: DecodeOptions, counts: StreamCounts) -> bool:
    """Decode each direction of each interface on its own; return whether something is missing."""
    printers: dict[DirectionStream, _TimedStreamPrinter] = {}
    start_ns: int | None = None
    with capture:
        for stream, items in diagnose_capture(
            capture, options.edition, options.direction, accept_unknown=options.accept_unknown
        ):
            if start_ns is None:
                start_ns = stream.start_ns
            if stream not in printers:
                printers[stream] = _TimedStreamPrinter(stream, capture, start_ns, options, counts)
            printers[stream].print(items)
            if items:
                # This also forgets times that are no longer needed, so it runs even if nothing is
                # printed.
                stream.time_of(items[-1].offset)
        return warn_if_incomplete(capture)
