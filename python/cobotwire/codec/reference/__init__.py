"""The reference codec: obvious before fast. The oracle of the tests, and the rules in Python."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from cobotwire.codec.columns import Columns, Scan
from cobotwire.codec.interface import Data, Listening, Message
from cobotwire.codec.reference.columns import ReferenceColumnReader, scan
from cobotwire.codec.reference.decode import decode
from cobotwire.codec.reference.encode import encode
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.codec.reference.legal import Forms
from cobotwire.codec.refusal import refuse_direction
from cobotwire.table import Direction, Table


class ReferenceCodec:
    """The pure-Python codec; see :class:`cobotwire.codec.interface.Codec`."""

    name: Literal["reference"] = "reference"

    def __init__(self, table: Table) -> None:
        self.table = table
        self._forms: dict[Direction, Forms] = {
            "request": Forms(table, "request"),
            "reply": Forms(table, "reply"),
        }

    def encode(
        self,
        command: str,
        direction: Direction,
        values: Sequence[Any],
        *,
        form: int | None = None,
        address: int | None = None,
    ) -> bytes:
        """Build one whole frame."""
        found = self.table.command(command)
        self._legal(direction)
        return encode(self.table.frame, found, direction, values, form, address)

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> Message:
        """Read one whole frame."""
        command = None if of is None else self.table.command(of)
        return decode(self._legal(direction), direction, data, command)

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """A new framer."""
        directions: tuple[Direction, ...] = (
            ("request", "reply") if listening == "both" else (listening,)
        )
        forms = [self._legal(direction) for direction in directions]
        return ReferenceFramer(self.table.frame, forms, accept_unknown)

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
    ) -> Scan:
        """Where the frames of a whole stream are; ``out`` keeps its memory."""
        framer = self.framer(listening, accept_unknown=accept_unknown)
        return scan([*framer.feed(data), *framer.flush()], framer)

    def decode_columns(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        raw: bool = False,
        out: Columns | None = None,
    ) -> Columns:
        """The values of a whole stream, as columns; ``out`` keeps its memory."""
        framer = self.framer(listening)
        return ReferenceColumnReader(self.table, framer, raw).all_of(data)

    def column_reader(
        self, listening: Listening = "both", *, raw: bool = False
    ) -> ReferenceColumnReader:
        """A reader for a stream that comes in pieces."""
        return ReferenceColumnReader(self.table, self.framer(listening), raw)

    def _legal(self, direction: Direction) -> Forms:
        if direction not in self._forms:
            raise refuse_direction(direction)
        return self._forms[direction]
