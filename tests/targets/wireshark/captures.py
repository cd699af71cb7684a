"""Make captures for the dissectors: recordings of serial lines, and TCP to port 9000."""

from __future__ import annotations

import io
import struct
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from cobotwire.capture import CaptureWriter, Direction, Interface, Packet
from cobotwire.codec.interface import Listening

DIRECTIONS: dict[Listening, Direction] = {"request": "sent", "reply": "received", "both": "unknown"}
START_NS = 1_700_000_000_000_000_000
# Nanoseconds between packets without a time: too short for a silence.
STEP_NS = 1000
ARM_PORT = 9000
_GLOBAL = struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 262144, 1)


class Chunk(NamedTuple):
    """Bytes sent together on line number ``line``; without a time, right after the last chunk."""

    line: int
    direction: Listening
    data: bytes
    at_ns: int = -1


def timed(chunks: Sequence[Chunk]) -> list[Chunk]:
    """Return the chunks, each with a time."""
    return [
        chunk if chunk.at_ns >= 0 else chunk._replace(at_ns=number * STEP_NS)
        for number, chunk in enumerate(chunks)
    ]


def serial(chunks: Sequence[Chunk], edition: str | Sequence[str]) -> bytes:
    """Return a recording in which each line is an interface and each chunk a packet.

    ``edition`` is the edition of all lines, or a list with one for each line.
    """
    file = io.BytesIO()
    writer = CaptureWriter(file)
    for line in range(1 + max((chunk.line for chunk in chunks), default=0)):
        named = edition if isinstance(edition, str) else edition[line]
        writer.interface(Interface(f"line {line}", named, 115200))
    for chunk in timed(chunks):
        time_ns, direction = START_NS + chunk.at_ns, DIRECTIONS[chunk.direction]
        writer.packet(Packet(time_ns, direction, chunk.data, "bytes", interface=chunk.line))
    writer.finish()
    return file.getvalue()


def tcp(chunks: Sequence[Chunk], edition: str = "") -> bytes:
    """Return a network capture in which each line is a connection and each chunk a segment."""
    del edition  # a segment does not name it
    sequences: dict[tuple[int, Listening], int] = defaultdict(lambda: 1000)
    packets = []
    for chunk in timed(chunks):
        to_arm, key = chunk.direction == "request", (chunk.line, chunk.direction)
        packets.append(segment(chunk, sequences[key], to_arm))
        sequences[key] += len(chunk.data)
    return pcap(zip((chunk.at_ns for chunk in timed(chunks)), packets))


def pcap(packets: Iterable[tuple[int, bytes]]) -> bytes:
    """Return a pcap file of Ethernet packets, each with its time."""
    records = (
        struct.pack("<IIII", *divmod(START_NS + at, 10**9), len(data), len(data)) + data
        for at, data in packets
    )
    return _GLOBAL + b"".join(records)


def segment(chunk: Chunk, sequence: int, to_arm: bool) -> bytes:
    """Return an Ethernet packet with a TCP segment; line n is the client's port 20000 + n."""
    client, arm = (20000 + chunk.line, b"\x0a\0\0\x01"), (ARM_PORT, b"\x0a\0\0\x02")
    (source, source_ip), (target, target_ip) = (client, arm) if to_arm else (arm, client)
    head = struct.pack(">HHIIBBHHH", source, target, sequence, 1, 5 << 4, 0x18, 65535, 0, 0)
    size = 20 + len(head) + len(chunk.data)
    ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, size, 0, 0, 64, 6, 0, source_ip, target_ip)
    ethernet = b"\x02" * 6 + b"\x04" * 6 + b"\x08\x00"
    return ethernet + ip + head + chunk.data
