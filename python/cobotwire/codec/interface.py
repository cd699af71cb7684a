"""The interface that the reference codec and the native codec implement.

Values are positional, one for each field of the variant: an ``int`` if the number has no scale, a
``float`` if it has one, a tuple of these for a ``many`` field.
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
        """Take bytes; return what is certain by now, in the order of the stream."""
        ...

    def flush(self) -> list[Event]:
        """Refute what still waits, because the line is idle; return it and what follows it."""
        ...

    @property
    def pending(self) -> int:
        """How many fed bytes no event covers yet; fewer than the longest frame has."""
        ...

    @property
    def counters(self) -> Counters:
        """The counts since the framer was made."""
        ...


class ColumnReader(Protocol):
    """Decodes a stream into columns chunk by chunk; how it is cut makes no difference."""

    def feed(self, data: Data) -> Columns:
        """Take bytes; return what has become certain since the last call.

        A span of noise is returned with the frame that ends it. The counters cover all fed bytes.
        """
        ...

    def flush(self) -> Columns:
        """Refute what still waits; return the rest."""
        ...

    @property
    def pending(self) -> int:
        """How many fed bytes are not accounted for yet; fewer than the longest frame has."""
        ...


class Codec(Protocol):
    """One edition's encoder, decoder and framer."""

    @property
    def name(self) -> Literal["reference", "native"]:
        """Which of the two codecs it is."""
        ...

    @property
    def table(self) -> Table:
        """The edition that it interprets."""
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

        The variant is the first one with that number of fields that allows the values, unless
        ``variant`` picks one by its index. ``address`` is only for formats with an address byte.

        Raises:
            UsageError: no such command or variant, or a value that the field does not allow. If
                several variants have that number of fields, the error is that of the first one.
        """
        ...

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> DecodedMessage:
        """Read ``data``, which must be one frame and nothing else.

        If commands share an id and a size, the result is the first that allows the values; ``of``
        names the only command that it may be. Frames that a framer returned have
        :meth:`Frame.decode`, which does not judge them again.

        Raises:
            UsageError: ``of`` names no command.
            ProtocolError: it is not a legal frame of that direction, or a field holds a value that
                the edition does not allow.
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
    ) -> Scan:
        """Return where the frames of a stream are.

        The result may reuse the memory of ``out``, an earlier result, which is then empty.

        Raises:
            BufferError: a memoryview or an array still uses ``out``.
        """
        ...

    def decode_columns(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        raw: bool = False,
        out: Columns | None = None,
    ) -> Columns:
        """Return the values of a stream as columns: physical values, or raw ones with ``raw``.

        A frame that can be a request or a reply counts as a request, unless ``listening`` is
        ``"reply"``. The result may reuse the memory of ``out``, an earlier result, which is then
        empty.

        Raises:
            BufferError: a memoryview or an array still uses ``out``.
        """
        ...

    def column_reader(self, listening: Listening = "both", *, raw: bool = False) -> ColumnReader:
        """Return a reader for a stream that comes in pieces, or is larger than memory."""
        ...
