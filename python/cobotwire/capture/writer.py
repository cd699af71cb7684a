"""Write packets to a pcapng file; pass each one to the operating system at once."""

from __future__ import annotations

from typing import BinaryIO

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.packet import Interface, Packet, comment_of

FLAGS = {"sent": blocks.OUTBOUND, "received": blocks.INBOUND, "unknown": 0}


class CaptureWriter:
    """Writes packets to an open binary file, which it does not close.

    Attributes:
        size: bytes written so far, in complete blocks.
    """

    def __init__(
        self, file: BinaryIO, application: str = "cobotwire", start_seconds: int = 0
    ) -> None:
        """Begin the file; ``application`` names the program that writes it.

        No packet may have a time before ``start_seconds``, which may be negative.
        """
        self._file, self._start = file, start_seconds
        self.size = 0
        # For each interface: the times of its first and last packet, and their number.
        self._seen: list[tuple[int, int, int]] = []
        self._write(blocks.section(application))

    def interface(self, interface: Interface) -> int:
        """Describe an interface; return the index for its packets."""
        edition = f"edition {interface.edition}" if interface.edition else ""
        self._write(blocks.interface(interface.url, edition, interface.baudrate, self._start))
        self._seen.append((0, 0, 0))
        return len(self._seen) - 1

    def packet(self, packet: Packet) -> None:
        """Write one packet of an interface that was described."""
        time_ns, start_ns = packet.time_ns - self._start * 10**9, self._start * 10**9
        first, last, count = self._seen[packet.interface]
        self._write(
            blocks.packet(
                packet.interface,
                time_ns,
                packet.data,
                FLAGS[packet.direction],
                comment_of(packet),
            )
        )
        end = packet.pieces[-1].time_ns if packet.pieces else packet.time_ns
        first = min(first, time_ns) if count else time_ns
        self._seen[packet.interface] = first, max(last, end - start_ns), count + 1

    def finish(self) -> None:
        """Mark the recording as finished, so that readers know that nothing is missing."""
        for index, (first, last, count) in enumerate(self._seen):
            self._write(blocks.statistics(index, first, last, count))

    def _write(self, block: bytes) -> None:
        self._file.write(block)
        # From now on the block is safe even if the process is killed.
        self._file.flush()
        self.size += len(block)
