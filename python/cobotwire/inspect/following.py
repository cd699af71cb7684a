"""Follow a recording while another program writes it: ``follow:FILE`` as a source of traffic."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterator
from itertools import islice
from math import inf
from pathlib import Path
from typing import Self

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import Packet
from cobotwire.capture.block_parsing import Truncated, blocks_of
from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.packet_parsing import PacketParser
from cobotwire.codec.interface import Noise
from cobotwire.protocol.errors import CaptureError
from cobotwire.session import Traffic, UnexpectedFrame

SCHEME = "follow:"
# A recording describes its first interface in its second block, which is written at once.
HEAD_BLOCKS, HEAD_SECONDS = 2, 1.0
# The seconds between two reads at the end of the file.
WAIT_SECONDS = 0.05
# The most items of traffic that wait to be taken; then the oldest is dropped.
QUEUED = 20_000


class _GrowingFile:
    """Waits at the end of a file for more, until it is stopped or a deadline has passed."""

    def __init__(self, path: str) -> None:
        if not Path(path).is_file():
            raise unusable_file("FILE", path, FileNotFoundError(2, "no such file"))
        self._file = open(path, "rb", buffering=0)  # noqa: SIM115  (closed by close())
        self._stopped = threading.Event()
        self.give_up_at = time.monotonic() + HEAD_SECONDS
        # Whether the initial contents of the file were read.
        self.at_end = False

    def read(self, size: int, /) -> bytes:
        while not (data := self._file.read(size)):
            self.at_end = True
            if self._stopped.wait(WAIT_SECONDS) or time.monotonic() > self.give_up_at:
                break
        return data or b""

    def stop(self) -> None:
        self._stopped.set()

    def close(self) -> None:
        self._file.close()


class FollowedRecording:
    """What is recorded while the ``with`` block runs; what was recorded before is skipped.

    Attributes:
        source: what is followed, ``follow:FILE``.
        url, baudrate: of the arm's port, as the recording states them.
        edition: the edition of the recording, if it is installed.
        table: the table of the edition.
        problem: why nothing comes any more; empty while the recording may grow.
    """

    def __init__(self, source: str, edition: str) -> None:
        """Open ``follow:FILE``; ``edition`` applies if the recording names none that is installed.

        Raises:
            UsageError: there is no such file, or it cannot be read.
            CaptureError: it is not a recording.
        """
        self.source, self.problem = source, ""
        name = source.removeprefix(SCHEME)
        try:
            self._file = _GrowingFile(name)
        except OSError as error:
            raise unusable_file("FILE", name, error) from None
        self._blocks, self._parser = blocks_of(self._file, name), PacketParser(name)
        try:
            for block in islice(self._blocks, HEAD_BLOCKS):
                self._parser.take(block)
            interface = self._parser.interfaces[0]
        except (Truncated, IndexError):
            self._file.close()
            raise CaptureError(name, 0, "it does not begin as a recording") from None
        except BaseException:
            self._file.close()
            raise
        self._file.give_up_at = inf
        self.url, self.baudrate = interface.url, interface.baudrate
        known = interface.edition in editions.names()
        self.edition = editions.load(interface.edition if known else edition)
        self.table = self.edition.TABLE
        self._framer = codecs.load(self.table).framer("reply")
        self._offset = time.monotonic() - time.time()
        self._queue: deque[Traffic] = deque(maxlen=QUEUED)
        self._thread = threading.Thread(target=self._run, name="cobotwire-follow", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._file.stop()
        self._thread.join()
        self._file.close()

    def take(self) -> list[Traffic]:
        """Return the traffic since the last call."""
        return [self._queue.popleft() for _ in range(len(self._queue))]

    def _run(self) -> None:
        reason = "it ends in the middle of a packet"
        try:
            for block in self._blocks:
                packet = self._parser.take(block)
                if packet is not None and self._file.at_end:
                    self._queue.extend(self._traffic(packet))
                if self._parser.finished:
                    break
            reason = "the recording has ended"
        except Truncated:
            pass
        except (CaptureError, OSError) as error:
            reason = str(error)
        self.problem = reason

    def _traffic(self, packet: Packet) -> Iterator[Traffic]:
        last_ns = packet.pieces[-1].time_ns if packet.pieces else packet.time_ns
        at = last_ns / 1e9 + self._offset
        if packet.direction == "sent":
            yield Traffic(at, "sent", packet.data)
            return
        # A packet is whole: no later byte belongs to it.
        for event in (*self._framer.feed(packet.data), *self._framer.flush()):
            made = event if isinstance(event, Noise) else UnexpectedFrame(event)
            yield Traffic(at, "received", event.data, made)
