"""What passes through a faulty peer: requests, replies in pieces, and what was done to them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.table import Command


class Request(NamedTuple):
    """Something that was heard.

    Attributes:
        at: seconds since the scenario began.
        data: its bytes.
        id: its command id; None: it is no request, but malformed input.
        command: what the edition calls it; None where it calls it nothing.
    """

    at: float
    data: bytes
    id: int | None
    command: Command | None

    @property
    def name(self) -> str:
        """What people call it."""
        if self.command is not None:
            return self.command.name
        return "malformed input" if self.id is None else f"0x{self.id:02X}"


class Piece(NamedTuple):
    """Bytes that are said together, ``pause`` seconds after those before them."""

    pause: float
    data: bytes


Reply = tuple[Piece, ...]


class Done(NamedTuple):
    """A fault that was done.

    Attributes:
        at: seconds since the scenario began.
        fault: its kind, as scenario files call it.
        request: the name of the request at which it was done.
        detail: what was done.
        added: how many bytes more the host will hear for it; below 0: how many less.
    """

    at: float
    fault: str
    request: str
    detail: str
    added: int

    def __str__(self) -> str:
        return f"{self.at:.3f} s {self.fault} at {self.request}: {self.detail}"


def joined(reply: Reply) -> bytes:
    """All bytes of a reply."""
    return b"".join(piece.data for piece in reply)


def recut(reply: Reply, data: bytes) -> Reply:
    """Other bytes, with the pauses where they were; what is too much stands in the last piece."""
    pieces: list[Piece] = []
    for piece in reply[:-1]:
        pieces.append(Piece(piece.pause, data[: len(piece.data)]))
        data = data[len(piece.data) :]
    pieces.append(Piece(reply[-1].pause if reply else 0.0, data))
    return tuple(piece for piece in pieces if piece.data)


def enlarged(reply: Reply, at: int, data: bytes) -> Reply:
    """The reply with more bytes at an offset; every pause stays before the byte that it is before.

    Those at its very end, or at its beginning, come without a pause.
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
    """The reply with a pause before each of these bytes; the pauses that it has stay."""
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
