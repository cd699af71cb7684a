"""What a capture holds: packets, each of them bytes that went over the line of an interface."""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

# "unknown" is what a capture of somebody else may leave open; ours never do.
Direction = Literal["sent", "heard", "unknown"]
# "bytes" is what nobody has looked into: a chunk as it was read or written.
Kind = Literal["frame", "noise", "bytes"]

_PIECE = re.compile(r"(\d+) bytes at \+(\d+) ns")
_MARK = "in pieces: "


class Piece(NamedTuple):
    """The bytes of a packet that came together."""

    size: int
    time_ns: int


class Packet(NamedTuple):
    """A frame, a span of noise, or a chunk.

    Attributes:
        time_ns: when its first byte was read or written, in nanoseconds since 1970 (UTC).
        direction: ``sent`` is what this side wrote, ``heard`` what it read.
        data: the bytes.
        kind: what they are, by the edition that the interface names.
        reason: why noise is none; empty for all else.
        pieces: where not all of it came at ``time_ns``: each piece with its own time; else empty.
        interface: the index of its line in ``CaptureReader.interfaces``.
    """

    time_ns: int
    direction: Direction
    data: bytes
    kind: Kind = "frame"
    reason: str = ""
    pieces: tuple[Piece, ...] = ()
    interface: int = 0


class Interface(NamedTuple):
    """One line that was recorded.

    Attributes:
        url: the port or URL; empty if the capture does not tell.
        edition: the edition by which the packets were cut; empty likewise.
        baudrate: bits a second; 0 likewise.
    """

    url: str
    edition: str = ""
    baudrate: int = 0


def comment_of(packet: Packet) -> str:
    """What the fields of pcapng have no place for; people read it in Wireshark, and we again."""
    words = []
    if packet.kind != "frame":
        words.append(f"{packet.kind} {packet.reason}".strip())
    if packet.pieces:
        # The start of the packet is the first piece's time; differences are easier to read.
        pieces = [f"{size} bytes at +{time - packet.time_ns} ns" for size, time in packet.pieces]
        words.append(_MARK + ", ".join(pieces))
    return "; ".join(words)


def with_comment(packet: Packet, comment: str) -> Packet:
    """The packet with what :func:`comment_of` said of it. Any other comment changes nothing."""
    for words in comment.split("; "):
        kind, _, reason = words.partition(" ")
        if kind == "noise" or words == "bytes":
            packet = packet._replace(kind="noise" if kind == "noise" else "bytes", reason=reason)
        elif words.startswith(_MARK):
            found = _PIECE.findall(words)
            pieces = tuple(Piece(int(size), packet.time_ns + int(late)) for size, late in found)
            if sum(piece.size for piece in pieces) == len(packet.data):
                packet = packet._replace(pieces=pieces)
    return packet
