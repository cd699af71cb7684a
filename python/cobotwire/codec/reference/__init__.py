"""Encode and decode in pure Python: the reference codec, simple rather than fast.

It is the specification of the native codec, and the oracle of the tests.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, SupportsIndex

from cobotwire.codec.columns import Columns, Scan
from cobotwire.codec.interface import Data, DecodedMessage, Listening
from cobotwire.codec.reference.columns import ReferenceColumnReader, scan
from cobotwire.codec.reference.decode import decode, read
from cobotwire.codec.reference.encode import encode
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.codec.reference.judge import Judge
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.rejection import reject_direction, reject_workers
from cobotwire.protocol.table import Direction, Table


class ReferenceCodec:
    """The pure-Python codec; see :class:`cobotwire.codec.interface.Codec`."""

    name: Literal["reference"] = "reference"

    def __init__(self, table: Table) -> None:
        self.table = table
        request, reply = FrameIndex(table, "request"), FrameIndex(table, "reply")
        self._judges: dict[str, Judge] = {
            "request": Judge(table.frame, [request]),
            "reply": Judge(table.frame, [reply]),
            "both": Judge(table.frame, [request, reply]),
        }

    def encode(
        self,
        command: str,
        direction: Direction,
        values: Sequence[Any],
        *,
        variant: int | None = None,
        address: int | None = None,
    ) -> bytes:
        """Build one frame."""
        found = self.table.command(command)
        self._judge(direction)
        return encode(self.table.frame, found, direction, values, variant, address)

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> DecodedMessage:
        """Decode exactly one frame."""
        command = None if of is None else self.table.command(of)
        return decode(self._judge(direction), data, command)

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """Return a new framer."""
        judge = self._judges["both"] if listening == "both" else self._judge(listening)
        if accept_unknown:
            judge = Judge(judge.frame, judge.indexes, accept_unknown=True)

        def read_frame(
            data: bytes, direction: Direction | None = None, of: str | None = None
        ) -> DecodedMessage:
            command = None if of is None else self.table.command(of)
            return read(judge if direction is None else self._judge(direction), data, command)

        return ReferenceFramer(judge, read_frame)

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
        workers: int = 1,
    ) -> Scan:
        """Return the places of frames and noise, without reuse of ``out``, and in this thread."""
        _check_workers(workers)
        framer = self.framer(listening, accept_unknown=accept_unknown)
        return scan([*framer.feed(data), *framer.flush()], framer)

    def decode_columns(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        raw: bool = False,
        out: Columns | None = None,
        workers: int = 1,
    ) -> Columns:
        """Return the values of a stream, without reuse of ``out``, and in this thread."""
        _check_workers(workers)
        framer = self.framer(listening)
        return ReferenceColumnReader(self.table, framer, raw).all_of(data)

    def column_reader(
        self, listening: Listening = "both", *, raw: bool = False, offset: int = 0
    ) -> ReferenceColumnReader:
        """Return a reader for a stream that comes in pieces."""
        framer = self.framer(listening)
        framer.start_at(offset)
        return ReferenceColumnReader(self.table, framer, raw)

    def _judge(self, direction: Direction) -> Judge:
        if direction not in ("request", "reply"):
            raise reject_direction(direction)
        return self._judges[direction]


def _check_workers(workers: int) -> None:
    if not isinstance(workers, SupportsIndex) or not 1 <= workers.__index__() < 2**16:
        raise reject_workers(workers)
