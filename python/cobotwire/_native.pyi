"""The Rust codec's binary: what ``cobotwire.codec.native`` gives out.

It reads a table's objects once, when a codec is made, and converts; what is legal is decided in
``rust/core``, and what an error says in ``cobotwire.codec.refusal``.
"""

from collections.abc import Sequence
from typing import Any, Literal, final

from typing_extensions import Buffer

from cobotwire.codec.columns import Columns, Scan
from cobotwire.codec.interface import Counters, Data, Event, Listening, Message
from cobotwire.table import Direction, Table

__all__ = ["Memory", "NativeCodec", "NativeColumnReader", "NativeFrame", "NativeFramer"]

@final
class NativeCodec:
    """One edition's encoder, decoder and framer; see :class:`cobotwire.codec.interface.Codec`."""

    def __new__(cls, table: Table) -> NativeCodec:
        """Read a table.

        Raises:
            AttributeError, TypeError, OverflowError: it is not a table, or something in it has the
                wrong type or is far too large.
            ValueError: it cannot be interpreted: the header is not two bytes, the check is unknown,
                the footer is not one byte where it is the check or not empty where it is not,
                a form is longer than LEN can say, a number is not one to four bytes wide, a scale
                or bound is beyond what a double holds exactly, or a field's cases do not fit.
        """

    @property
    def name(self) -> Literal["native"]:
        """Which of the two codecs it is."""

    @property
    def table(self) -> Table:
        """The edition that it interprets."""

    def encode(
        self,
        command: str,
        direction: Direction,
        values: Sequence[Any],
        *,
        form: int | None = None,
        address: int | None = None,
    ) -> bytes:
        """Build one whole frame, of the first form of that many fields that takes ``values``.

        ``form`` picks one by its index; ``address`` is only for formats with an address byte.

        Raises:
            UsageError: no such command, address or form, or a value that the field does not allow.
        """

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> Message:
        """Read ``data``, which must be one whole frame and nothing else.

        Calls that share an id and a size read as the first of them that allows the values, unless
        ``of`` names the one that it must be.

        Raises:
            UsageError: ``of`` names no command.
            ProtocolError: it is not a legal frame of that direction, or a field holds a value that
                the edition does not allow.
        """

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> NativeFramer:
        """A new framer; ``accept_unknown`` also takes ids that the edition lacks as frames."""

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
    ) -> Scan:
        """Where the frames of a whole stream are; see the interface.

        Raises:
            BufferError: ``out`` is still looked at, by a memoryview or an array.
        """

    def decode_columns(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        raw: bool = False,
        out: Columns | None = None,
    ) -> Columns:
        """The values of a whole stream, as columns; see the interface.

        Raises:
            BufferError: ``out`` is still looked at, by a memoryview or an array.
        """

    def column_reader(
        self, listening: Listening = "both", *, raw: bool = False
    ) -> NativeColumnReader:
        """A reader for a stream that comes in pieces, or is larger than memory."""

@final
class NativeFramer:
    """Cuts frames out of a byte stream; see :class:`cobotwire.codec.interface.Framer`.

    Made by :meth:`NativeCodec.framer`. Not for use by two threads at once.
    """

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; give what is certain by now, in the order of the stream."""

    def flush(self) -> list[Event]:
        """Refute what still waits (the line has been idle): a true frame behind it comes now."""

    @property
    def pending(self) -> int:
        """Bytes fed that no event covers yet; less than the longest frame."""

    @property
    def counters(self) -> Counters:
        """What came so far, in numbers."""

@final
class NativeFrame:
    """A whole, legal frame; a kind of :class:`cobotwire.codec.events.Frame`.

    It carries its bytes, and is decoded when it is first asked for its message or values.
    """

    @property
    def offset(self) -> int:
        """Where it starts in the stream."""

    @property
    def data(self) -> bytes:
        """All of it, from header to check."""

    @property
    def command(self) -> int:
        """Its command id."""

    @property
    def message(self) -> Message:
        """What it says, as the first message that allows its values.

        Raises:
            ProtocolError: a field holds a value that the edition does not allow, or the edition
                lacks its id.
        """

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of its message, one a field.

        Raises:
            ProtocolError: as ``message``.
        """

    def __eq__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class NativeColumnReader:
    """Decodes a stream into columns; see :class:`cobotwire.codec.interface.ColumnReader`.

    Made by :meth:`NativeCodec.column_reader`. Not for use by two threads at once.
    """

    def feed(self, data: Data) -> Columns:
        """Take bytes; give what is certain by now, and was not given before."""

    def flush(self) -> Columns:
        """Refute what still waits, and give the rest."""

    @property
    def pending(self) -> int:
        """Bytes fed that are not accounted for yet; less than the longest frame."""

@final
class Memory(Buffer):
    """Numbers in memory, for memoryviews, NumPy and Arrow; read-only."""
