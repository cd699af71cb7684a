"""Packets to a pcapng file, one by one: what was written is whole, whatever happens later."""

from __future__ import annotations

from typing import BinaryIO

from cobotwire.capture import blocks
from cobotwire.capture.packet import Interface, Packet, comment_of

FLAGS = {"sent": blocks.OUTBOUND, "heard": blocks.INBOUND, "unknown": 0}


class CaptureWriter:
    """Writes packets to an open binary file, which it does not close.

    Attributes:
        size: how many bytes of whole blocks were written.
    """

    def __init__(self, file: BinaryIO, application: str = "cobotwire") -> None:
        """Begin the file; ``application`` is what the capture says wrote it."""
        self._file = file
        self.size = 0
        # For each interface: the times of its first and last packet, and how many there were.
        self._seen: list[tuple[int, int, int]] = []
        self._write(blocks.section(application))

    def interface(self, interface: Interface) -> int:
        """Introduce a line; gives the index by which its packets name it."""
        edition = f"edition {interface.edition}" if interface.edition else ""
        self._write(blocks.interface(interface.url, edition, interface.baudrate))
        self._seen.append((0, 0, 0))
        return len(self._seen) - 1

    def packet(self, packet: Packet) -> None:
        """Write one packet of a line that was introduced."""
        first, last, count = self._seen[packet.interface]
        self._write(
            blocks.packet(
                packet.interface,
                packet.time_ns,
                packet.data,
                FLAGS[packet.direction],
                comment_of(packet),
            )
        )
        end = packet.pieces[-1].time_ns if packet.pieces else packet.time_ns
        first = min(first, packet.time_ns) if count else packet.time_ns
        self._seen[packet.interface] = first, max(last, end), count + 1

    def finish(self) -> None:
        """Say that nothing is missing: the recording ends because it was told to."""
        for index, (first, last, count) in enumerate(self._seen):
            self._write(blocks.statistics(index, first, last, count))

    def _write(self, block: bytes) -> None:
        self._file.write(block)
        # A process that is killed leaves whole blocks behind; the system has them from here on.
        self._file.flush()
        self.size += len(block)
