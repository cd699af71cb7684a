"""What passes through a faulty peer: requests, replies in pieces, and the applied faults."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.protocol.table import Command


class Request(NamedTuple):
    """Something that the host sent.

    Attributes:
        at: seconds since the scenario began.
        data: its bytes.
        id: its command id; None: it is not a request, but malformed input.
        command: the edition's command; None: the edition has no command of this id.
    """

    at: float
    data: bytes
    id: int | None
    command: Command | None

    @property
    def name(self) -> str:
        """The name of the command, or its id."""
        if self.command is not None:
            return self.command.name
        return "malformed input" if self.id is None else f"0x{self.id:02X}"


class Piece(NamedTuple):
    """Bytes that are sent together, ``pause`` seconds after those before them."""

    pause: float
    data: bytes


Reply = tuple[Piece, ...]


class AppliedFault(NamedTuple):
    """A fault that was applied.

    Attributes:
        at: seconds since the scenario began.
        fault: its kind, as scenario files call it.
        request: the name of the request to which it was applied.
        detail: what it did.
        added: how many more bytes the host receives because of it; negative: how many fewer.
    """

    at: float
    fault: str
    request: str
    detail: str
    added: int

    def __str__(self) -> str:
        return f"{self.at:.3f} s {self.fault} at {self.request}: {self.detail}"


def joined(reply: Reply) -> bytes:
    """Return all bytes of a reply."""
    return b"".join(piece.data for piece in reply)


def recut(reply: Reply, data: bytes) -> Reply:
    """Return other bytes with the pauses of a reply; the last piece has all that is left."""
    pieces: list[Piece] = []
    for piece in reply[:-1]:
        pieces.append(Piece(piece.pause, data[: len(piece.data)]))
        data = data[len(piece.data) :]
    pieces.append(Piece(reply[-1].pause if reply else 0.0, data))
    return tuple(piece for piece in pieces if piece.data)


def enlarged(reply: Reply, at: int, data: bytes) -> Reply:
    """Return a reply with more bytes at an offset; each pause stays before the same byte.

    Bytes at the very end or beginning come without a pause.
    """
    pieces: list[Piece] = []
    for piece in reply:
        size = len(piece.data)
        if 0 <= at <= size:
            pieces.append(Piece(piece.pause, piece.data[:at] + data + piece.data[at:]))
            at = -1
        else:
            pieces.append(piece)
            at -= size
    return tuple(pieces)


def spread(reply: Reply, cuts: Sequence[int], pause: float) -> Reply:
    """Return a reply with additional pauses before the bytes at the offsets ``cuts``."""
    pieces: list[Piece] = []
    start = 0
    for piece in reply:
        inner = [cut - start for cut in cuts if 0 < cut - start < len(piece.data)]
        ends = [*inner, len(piece.data)]
        for number, (begin, end) in enumerate(zip([0, *inner], ends)):
            first = piece.pause + (pause if start in cuts and start else 0.0)
            pieces.append(Piece(pause if number else first, piece.data[begin:end]))
        start += len(piece.data)
    return tuple(pieces)


def followed_by(first: Reply, pause: float, reply: Reply) -> Reply:
    """Return two replies as one; without a pause they are in one piece."""
    if reply and not pause + reply[0].pause:
        glued = Piece(first[-1].pause, first[-1].data + reply[0].data)
        return (*first[:-1], glued, *reply[1:])
    return (*first, *(Piece(pause + p.pause if p is reply[0] else p.pause, p.data) for p in reply))
