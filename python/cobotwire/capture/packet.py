"""Define what a capture holds: packets of bytes, each sent or received on one interface."""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

# Captures of other programs may lack the direction; ours always have it.
Direction = Literal["sent", "received", "unknown"]
# "bytes" is a chunk as it was read or written, not cut into frames.
Kind = Literal["frame", "noise", "bytes"]

# Both numbers have at most 19 digits: the time stamps of a capture have 64 bits.
_PIECE = re.compile(r"(?<![0-9])([0-9]{1,19}) bytes at \+([0-9]{1,19}) ns")
_MARK = "in pieces: "


class Piece(NamedTuple):
    """Some bytes of a packet that were read or written together, with their time."""

    size: int
    time_ns: int


class Packet(NamedTuple):
    """A frame, a span of noise, or a raw chunk.

    Attributes:
        time_ns: when the first byte was read or written, in nanoseconds since 1970 (UTC).
        direction: ``sent`` is what the recording side wrote, ``received`` what it read.
        data: the bytes.
        kind: whether the bytes are a frame of the interface's edition, noise, or a raw chunk.
        reason: the framer's reason for noise; empty for frames and raw chunks.
        pieces: each piece with its own time, if the bytes did not all come at ``time_ns``.
        interface: an index into ``CaptureReader.interfaces``.
    """

    time_ns: int
    direction: Direction
    data: bytes
    kind: Kind = "frame"
    reason: str = ""
    pieces: tuple[Piece, ...] = ()
    interface: int = 0


class Interface(NamedTuple):
    """A serial port, socket or other transport that was recorded.

    Attributes:
        url: the port or URL; empty if the capture does not name it.
        edition: the edition of the frames; empty if the capture does not name it.
        baudrate: bits a second; 0 if the capture does not state it.
    """

    url: str
    edition: str = ""
    baudrate: int = 0


def comment_of(packet: Packet) -> str:
    """Return the facts that pcapng has no field for, as a comment that Wireshark shows.

    :func:`with_comment` reads it.
    """
    parts = []
    if packet.kind != "frame":
        parts.append(f"{packet.kind} {packet.reason}".strip())
    if packet.pieces:
        # Differences from the packet's own time are easier to read than absolute times.
        pieces = [f"{size} bytes at +{time - packet.time_ns} ns" for size, time in packet.pieces]
        parts.append(_MARK + ", ".join(pieces))
    return "; ".join(parts)


def with_comment(packet: Packet, comment: str) -> Packet:
    """Return the packet with the facts that :func:`comment_of` wrote; ignore other comments."""
    for part in comment.split("; "):
        kind, _, reason = part.partition(" ")
        if kind == "noise" or part == "bytes":
            packet = packet._replace(kind="noise" if kind == "noise" else "bytes", reason=reason)
        elif part.startswith(_MARK):
            found = _PIECE.findall(part)
            pieces = tuple(Piece(int(size), packet.time_ns + int(late)) for size, late in found)
            if sum(piece.size for piece in pieces) == len(packet.data):
                packet = packet._replace(pieces=pieces)
    return packet
