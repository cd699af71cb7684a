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
from cobotwire.codec.reference.validator import Validator
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.rejection import reject_direction, reject_workers
from cobotwire.protocol.table import Direction, Table


class ReferenceCodec:
    """The pure-Python codec; see :class:`cobotwire.codec.interface.Codec`."""

    name: Literal["reference"] = "reference"

    def __init__(self, table: Table) -> None:
        self.table = table
        request, reply = FrameIndex(table, "request"), FrameIndex(table, "reply")
        self._validators: dict[str, Validator] = {
            "request": Validator(table.frame, [request]),
            "reply": Validator(table.frame, [reply]),
            "both": Validator(table.frame, [request, reply]),
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
        self._validator(direction)
        return encode(self.table.frame, found, direction, values, variant, address)

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> DecodedMessage:
        """Decode exactly one frame."""
        command = None if of is None else self.table.command(of)
        return decode(self._validator(direction), data, command)

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """Return a new framer."""
        validator = self._validators["both"] if listening == "both" else self._validator(listening)
        if accept_unknown:
            validator = Validator(validator.frame, validator.indexes, accept_unknown=True)

        def read_frame(
            data: bytes, direction: Direction | None = None, of: str | None = None
        ) -> DecodedMessage:
            command = None if of is None else self.table.command(of)
            return read(
                validator if direction is None else self._validator(direction), data, command
            )

        return ReferenceFramer(validator, read_frame)

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
        workers: int = 1,
    ) -> Scan:
        """Return the offsets of frames and noise, without reuse of ``out``, and in this thread."""
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
        """Return a reader for a stream that arrives in chunks."""
        framer = self.framer(listening)
        framer.start_at(offset)
        return ReferenceColumnReader(self.table, framer, raw)

    def _validator(self, direction: Direction) -> Validator:
        if direction not in ("request", "reply"):
            raise reject_direction(direction)
        return self._validators[direction]


def _check_workers(workers: int) -> None:
    if not isinstance(workers, SupportsIndex) or not 1 <= workers.__index__() < 2**16:
        raise reject_workers(workers)
