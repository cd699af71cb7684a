"""What the watching process does: it records what passes a tap, and shows it."""

from __future__ import annotations

import os
import select
import time
from collections.abc import Callable, Iterable

from cobotwire.capture import Packet, Recording
from cobotwire.capture.recorder import Side
from cobotwire.codec.interface import Codec
from cobotwire.inspect.tap.copies import Copy, CopyReader

READ_SIZE = 1 << 16
# An incomplete frame is shown after a pause of the line; pauses are looked for at this interval.
TICK_SECONDS = 0.25
# Copies are collected for this long: a process that woke up for each would take the processor from
# the program and from the forwarder, just when they need it. Its priority is low, too.
COLLECTED_SECONDS = 0.02
NICENESS = 10


class Watching:
    """Reads the copies of a forwarder, cuts them into packets, and records them."""

    def __init__(
        self,
        copies: int,
        codec: Codec,
        recording: Recording | None,
        on_packet: Callable[[Packet], None],
        on_other: Callable[[Copy], None],
    ) -> None:
        """Read ``copies``; ``on_other`` gets those that are not traffic of the arm."""
        self._pipe, self._recording = copies, recording
        self._on_packet, self._on_other = on_packet, on_other
        self._sides = {
            "sent": Side("sent", codec.framer("request")),
            "received": Side("received", codec.framer("reply")),
        }
        self._reader = CopyReader()
        self._epoch_ns = time.time_ns() - time.monotonic_ns()
        self._dropped, self._reported = 0, False

    def run(self, between: Callable[[], None]) -> None:
        """Watch until the forwarder ends; call ``between`` from time to time.

        Raises:
            CaptureError: the recording is incomplete.
        """
        os.nice(NICENESS)
        while self._turn():
            between()
            time.sleep(COLLECTED_SECONDS)
        self._show(packet for side in self._sides.values() for packet in side.flush())
        if self._recording is not None:
            if self._dropped:
                self._recording.incomplete = f"{self._dropped} bytes came too fast"
            self._recording.close()

    def _turn(self) -> bool:
        if select.select([self._pipe], [], [], TICK_SECONDS)[0]:
            data = os.read(self._pipe, READ_SIZE)
            for copy in self._reader.feed(data):
                self._take(copy)
            if not data:
                return False
        now = time.monotonic()
        self._show(p for side in self._sides.values() for p in side.wake(self._time_ns(now)))
        if self._recording is not None:
            # Without new bytes the recording writes an incomplete frame after a pause.
            self._recording.record("sent", b"", now)
            if self._recording.failure and not self._reported:
                self._reported = True
                text = f"the recording ends here: {self._recording.failure}"
                self._on_other(Copy("note", now, text.encode()))
        return True

    def _take(self, copy: Copy) -> None:
        if copy.kind == "sent" or copy.kind == "received":
            self._show(self._sides[copy.kind].feed(copy.data, self._time_ns(copy.time)))
            if self._recording is not None:
                self._recording.record(copy.kind, copy.data, copy.time)
        else:
            self._dropped += int(copy.data) if copy.kind == "dropped" else 0
            self._on_other(copy)

    def _time_ns(self, seconds: float) -> int:
        return self._epoch_ns + round(seconds * 1e9)

    def _show(self, packets: Iterable[Packet]) -> None:
        for packet in packets:
            self._on_packet(packet)
