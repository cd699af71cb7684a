"""Hold the messages of one variant in a capture as columns, with times and directions."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from cobotwire.capture.packet import Direction
from cobotwire.codec.columns import Rows, join_rows, stamp_arrays
from cobotwire.protocol import table as tables

if TYPE_CHECKING:
    from typing_extensions import Buffer

    from cobotwire.codec.columns import Arrays

# The directions of packets; a column of directions holds indexes into this.
DIRECTIONS: tuple[Direction, ...] = ("unknown", "received", "sent")


class Part(NamedTuple):
    """A run of ``number`` adjacent rows that come from one stream."""

    interface: int
    direction: Direction
    number: int


class CapturedRows:
    """All messages of one variant in a capture: a column for each field, time and origin.

    Attributes:
        command: the command of the messages.
        message_direction: whether they are requests or replies.
        variant_index: the index of their variant.
        parts: the streams that the rows come from, one after another.
    """

    def __init__(self, rows: Rows, time: Buffer, parts: Sequence[Part]) -> None:
        self._rows = rows
        self._time = time
        self.parts = tuple(parts)
        self.command = rows.command
        self.message_direction = rows.direction
        self.variant_index = rows.variant_index

    @property
    def variant(self) -> tables.Variant:
        """The variant of the messages, with its fields."""
        return self._rows.variant

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the fields' columns."""
        return self._rows.names

    @property
    def time(self) -> memoryview:
        """The time of the first byte of each message: 64-bit nanoseconds since 1970 (UTC)."""
        return memoryview(self._time)

    @property
    def offset(self) -> memoryview:
        """The offset of each message in the byte stream of its interface and direction."""
        return self._rows.offset

    @property
    def address(self) -> memoryview | None:
        """The address byte of each message; None if frames of the edition have no address."""
        return self._rows.address

    @property
    def direction(self) -> memoryview:
        """The direction of each message's packets: 8-bit indexes into ``DIRECTIONS``."""
        parts = [
            array("b", [DIRECTIONS.index(part.direction)]) * part.number for part in self.parts
        ]
        return memoryview(sum(parts, array("b")))

    @property
    def interface(self) -> memoryview:
        """The index of each message's interface: 32-bit unsigned integers."""
        parts = [array("I", [part.interface]) * part.number for part in self.parts]
        return memoryview(sum(parts, array("I")))

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, name: str) -> memoryview[Any]:
        """Return the column of a field.

        Raises:
            UsageError: the variant has no such field.
        """
        return self._rows[name]

    def __repr__(self) -> str:
        command, direction = self.command.name, self.message_direction
        return f"<CapturedRows {command} {direction} {self.variant_index}: {len(self)}>"

    def to_numpy(self) -> Arrays:
        """Return the columns as arrays by name.

        They are ``time``, ``direction``, ``interface``, ``offset``, ``address`` if frames have an
        address byte, and the fields. ``time`` is ``datetime64[ns]``; ``direction`` holds texts.
        Fields are as in :meth:`cobotwire.codec.columns.Rows.to_numpy`.

        Raises:
            ImportError: NumPy (the extra ``numpy``) is not installed.
        """
        stamps = stamp_arrays(self.time, self.direction, DIRECTIONS, self.interface)
        return {**stamps, **self._rows.to_numpy()}

    def to_arrow(self, *, wide: bool = False) -> Any:
        """Return the rows as a ``pyarrow.Table``.

        The columns are ``time`` (``timestamp[ns]``, UTC), ``direction`` (dictionary),
        ``interface``, ``offset``, ``address`` if frames have an address byte, and the fields, which
        are as in :meth:`cobotwire.codec.columns.Rows.to_arrow`.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
        """
        return self._rows.to_arrow(wide=wide, leading=self.leading())

    def leading(self) -> dict[str, Any]:
        """Return the columns of :meth:`to_arrow` before the address and the fields.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
        """
        from cobotwire.codec.arrow import stamps

        when = stamps(self.time, self.direction, DIRECTIONS, self.interface)
        return {**when, "offset": self.offset}

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Return the Arrow PyCapsule stream of :meth:`to_arrow`."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)


def join(found: Sequence[CapturedRows]) -> CapturedRows:
    """Join rows of one variant from several streams into a copy, in the order of ``found``."""
    times = b"".join([cast("bytes", rows.time) for rows in found])
    rows = join_rows([rows._rows for rows in found])
    parts = [part for rows in found for part in rows.parts]
    return CapturedRows(rows, memoryview(times).cast("q"), parts)
