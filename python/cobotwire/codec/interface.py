"""Define the interface that the reference codec and the native codec implement.

Values are positional, one for each field of the variant: an ``int`` if the number has no scale, a
``float`` if it has one, or a tuple of these for a ``many`` field.
"""

from __future__ import annotations

from collections.abc import Sequence
from mmap import mmap
from typing import Any, Literal, Protocol

from cobotwire.codec.columns import Columns, Rows, Scan
from cobotwire.codec.events import Counters, DecodedMessage, Event, Frame, Noise, NoiseReason
from cobotwire.protocol.table import Direction, Table

__all__ = [
    "Codec",
    "ColumnReader",
    "Columns",
    "Counters",
    "Data",
    "DecodedMessage",
    "Event",
    "Frame",
    "Framer",
    "Listening",
    "Noise",
    "NoiseReason",
    "Rows",
    "Scan",
]

Data = bytes | bytearray | memoryview | mmap

Listening = Literal["request", "reply", "both"]


class Framer(Protocol):
    """Cuts frames out of a byte stream; see the law of framing in ``docs/framing.md``."""

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; return the events that are certain by now, in the order of the stream."""
        ...

    def flush(self) -> list[Event]:
        """Stop waiting for more bytes, because the line is idle; return the remaining events."""
        ...

    @property
    def pending(self) -> int:
        """The number of fed bytes that no event covers yet: fewer than the longest frame has."""
        ...

    @property
    def fed(self) -> int:
        """The number of bytes fed since the framer was created."""
        ...

    @property
    def counters(self) -> Counters:
        """The counts since the framer was created."""
        ...


class ColumnReader(Protocol):
    """Decodes a stream into columns, chunk by chunk; the rows do not depend on the chunks.

    Several threads may use it one after another, for instance with a lock. While a thread uses it,
    every use by another one raises UsageError and changes nothing.
    """

    def feed(self, data: Data) -> Columns:
        """Take bytes; return the rows and noise that became certain since the last call.

        A span of noise is returned with the frame that ends it. The counters cover all fed bytes.
        """
        ...

    def flush(self) -> Columns:
        """Stop waiting for more bytes; return the remaining rows and noise."""
        ...

    @property
    def pending(self) -> int:
        """The number of fed bytes that wait for more: fewer than the longest frame has."""
        ...


class Codec(Protocol):
    """One edition's encoder, decoder and framer."""

    @property
    def name(self) -> Literal["reference", "native"]:
        """The name of the codec."""
        ...

    @property
    def table(self) -> Table:
        """The table of the edition."""
        ...

    def encode(
        self,
        command: str,
        direction: Direction,
        values: Sequence[Any],
        *,
        variant: int | None = None,
        address: int | None = None,
    ) -> bytes:
        """Build one frame.

        ``values`` are encoded with the first variant that has as many fields and allows the values,
        unless ``variant`` picks one by its index. ``address`` is only for formats with an address
        byte.

        Raises:
            UsageError: there is no such command or variant, or a field does not allow its value.
                If several variants have as many fields, the error is that of the first one.
        """
        ...

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> DecodedMessage:
        """Decode ``data``, which must be exactly one frame.

        If commands share an id and a size, the result is the first one that allows the values;
        ``of`` restricts it to one command. For a frame that a framer returned, use
        :meth:`Frame.decode`, which does not check the frame again.

        Raises:
            UsageError: ``of`` names no command.
            ProtocolError: ``data`` is not a legal frame of that direction, or a field holds a value
                that the edition does not allow.
        """
        ...

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> Framer:
        """Return a new framer; with ``accept_unknown`` it accepts ids that the edition lacks."""
        ...

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
        workers: int = 1,
    ) -> Scan:
        """Return the offsets of the frames and the noise in a stream.

        ``out`` is an earlier result; the new result may reuse its memory, which empties ``out``.
        ``workers`` is the number of threads that may read a large stream together; the result does
        not depend on it.

        Raises:
            BufferError: a memoryview or an array still uses ``out``.
            UsageError: ``workers`` is not a number from 1 to 65535.
        """
        ...

    def decode_columns(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        raw: bool = False,
        out: Columns | None = None,
        workers: int = 1,
    ) -> Columns:
        """Return the values of a stream as columns: physical values, or raw ones with ``raw``.

        A frame that can be a request or a reply counts as a request, unless ``listening`` is
        ``"reply"``. ``out`` is an earlier result; the new result may reuse its memory, which
        empties ``out``. ``workers`` is the number of threads that may read a large stream together;
        the result does not depend on it.

        Raises:
            BufferError: a memoryview or an array still uses ``out``.
            UsageError: ``workers`` is not a number from 1 to 65535.
        """
        ...

    def column_reader(
        self, listening: Listening = "both", *, raw: bool = False, offset: int = 0
    ) -> ColumnReader:
        """Return a reader for a stream that arrives in chunks, or is larger than memory.

        ``offset`` is the position of the first fed byte in the stream; it is added to the offsets
        of rows, rejected frames and noise. The counters count only the bytes that are fed.

        Raises:
            UsageError: ``offset`` is negative or beyond 63 bits.
        """
        ...
