"""What a codec is: the one interface behind which the reference and the native codec stand.

Values are positional, one a field of the layout: an ``int`` where the scale is one, a ``float``
where it is not, a tuple of these for a ``many`` field.
"""

from __future__ import annotations

from collections.abc import Sequence
from mmap import mmap
from typing import Any, Literal, Protocol

from cobotwire.codec.columns import Columns, Rows, Scan
from cobotwire.codec.events import Counters, Event, Frame, Message, Noise, NoiseReason
from cobotwire.table import Direction, Table

__all__ = [
    "Codec",
    "ColumnReader",
    "Columns",
    "Counters",
    "Data",
    "Event",
    "Frame",
    "Framer",
    "Listening",
    "Message",
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
        """Take bytes; give what is certain by now, in the order of the stream."""
        ...

    def flush(self) -> list[Event]:
        """Refute what still waits (the line has been idle): a true frame behind it comes now."""
        ...

    @property
    def pending(self) -> int:
        """Bytes fed that no event covers yet; less than the longest frame."""
        ...

    @property
    def counters(self) -> Counters:
        """What came so far, in numbers."""
        ...


class ColumnReader(Protocol):
    """Decodes a stream, chunk by chunk, into columns; the chunks do not show in the rows."""

    def feed(self, data: Data) -> Columns:
        """Take bytes; give what is certain by now, and was not given before.

        A span of noise is given with the frame that ends it. The counters are of all that was fed.
        """
        ...

    def flush(self) -> Columns:
        """Refute what still waits, and give the rest."""
        ...

    @property
    def pending(self) -> int:
        """Bytes fed that are not accounted for yet; less than the longest frame."""
        ...


class Codec(Protocol):
    """One edition's encoder, decoder and framer."""

    @property
    def name(self) -> Literal["reference", "native"]:
        """Which of the two it is."""
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
        form: int | None = None,
        address: int | None = None,
    ) -> bytes:
        """Build one whole frame.

        The form is the first one with that number of fields that takes the values, unless ``form``
        picks one by its index. ``address`` is only for formats with an address byte.

        Raises:
            UsageError: no such command or form, or a value that the field does not allow (where
                several forms fit in number, the first one's complaint).
        """
        ...

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> Message:
        """Read ``data``, which must be one whole frame and nothing else.

        Calls that share an id and a size read as the first of them that allows the values, unless
        ``of`` names the one that it must be.

        Raises:
            UsageError: ``of`` names no command.
            ProtocolError: it is not a legal frame of that direction, or a field holds a value that
                the edition does not allow.
        """
        ...

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> Framer:
        """A new framer; ``accept_unknown`` also takes ids that the edition lacks as frames."""
        ...

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
    ) -> Scan:
        """Where the frames of a whole stream are.

        ``out``, an earlier result, may give its memory to the new one, and is then empty.

        Raises:
            BufferError: ``out`` is still looked at, by a memoryview or an array.
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
        """The values of a whole stream, as columns.

        With ``raw`` they are the whole numbers of the wire, after the sign rule. A frame that can
        be a request and a reply is taken for a request, unless only replies are listened to.
        ``out``, an earlier result, may give its memory to the new one, and is then empty.

        Raises:
            BufferError: ``out`` is still looked at, by a memoryview or an array.
        """
        ...

    def column_reader(self, listening: Listening = "both", *, raw: bool = False) -> ColumnReader:
        """A reader for a stream that comes in pieces, or is larger than memory."""
        ...
