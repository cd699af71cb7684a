"""The binary of the Rust codec, which ``cobotwire.codec.native`` exports.

A codec reads the objects of its table once, when it is made. ``rust/core`` decides what is legal,
and ``cobotwire.protocol.rejection`` makes the sentences of the errors.
"""

from collections.abc import Callable, Sequence
from typing import Any, Literal, final

from typing_extensions import Buffer

from cobotwire.codec.columns import Columns, Scan
from cobotwire.codec.interface import (
    Counters,
    Data,
    DecodedMessage,
    Event,
    Listening,
    Noise,
)
from cobotwire.diagnose.servo_bus import Vocabulary
from cobotwire.diagnose.stream_summary import Rest
from cobotwire.protocol.table import Command, Direction, Table

__all__ = [
    "AlarmClock",
    "Memory",
    "NativeCaptureReader",
    "NativeCodec",
    "NativeColumnReader",
    "NativeFrame",
    "NativeFramer",
    "NativeSummary",
    "__version__",
    "read_within",
    "write_now",
]

__version__: str

@final
class NativeCodec:
    """One edition's encoder, decoder and framer; see :class:`cobotwire.codec.interface.Codec`."""

    def __new__(cls, table: Table) -> NativeCodec:
        """Read a table.

        Raises:
            AttributeError, TypeError, OverflowError: it is not a table, or something in it has the
                wrong type or is far too large.
            ValueError: it cannot be interpreted: the header does not have 1 to 4 bytes, the check
                is unknown, the footer does not fit the check, a variant is longer than LEN can
                state, a number is wider than its encoding allows, a double cannot hold a scale or
                bound exactly, or a field's cases do not fit.
        """

    @property
    def name(self) -> Literal["native"]:
        """The name of the codec."""

    @property
    def table(self) -> Table:
        """The table of the edition."""

    def encode(
        self,
        command: str,
        direction: Direction,
        values: Sequence[Any],
        *,
        variant: int | None = None,
        address: int | None = None,
    ) -> bytes:
        """Build one frame with the first variant that has as many fields and allows ``values``.

        ``variant`` picks one by its index; ``address`` is only for formats with an address byte.

        Raises:
            UsageError: no such command, address or variant, or a value that its field rejects.
        """

    def decode(self, direction: Direction, data: bytes, *, of: str | None = None) -> DecodedMessage:
        """Read ``data``, which must be one frame and nothing else.

        If commands share an id and a size, the result is the first that allows the values; ``of``
        restricts the result to one command.

        Raises:
            UsageError: ``of`` names no command.
            ProtocolError: it is not a legal frame of that direction, or a field holds a value that
                the edition does not allow.
        """

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> NativeFramer:
        """Return a new framer; with ``accept_unknown`` it accepts ids that the edition lacks."""

    def scan(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        accept_unknown: bool = False,
        out: Scan | None = None,
        workers: int = 1,
    ) -> Scan:
        """Return the offsets of the frames and the noise in a stream; see the interface.

        Raises:
            BufferError: a memoryview or an array still uses ``out``.
            UsageError: ``workers`` is not a number from 1 to 65535.
        """

    def decode_columns(
        self,
        data: Data,
        listening: Listening = "both",
        *,
        raw: bool = False,
        out: Columns | None = None,
        workers: int = 1,
    ) -> Columns:
        """Return the values of a stream as columns; see the interface.

        Raises:
            BufferError: a memoryview or an array still uses ``out``.
            UsageError: ``workers`` is not a number from 1 to 65535.
        """

    def column_reader(
        self, listening: Listening = "both", *, raw: bool = False, offset: int = 0
    ) -> NativeColumnReader:
        """Return a reader for a stream that arrives in chunks, or is larger than memory.

        Raises:
            UsageError: ``offset``, the position of the first fed byte, is negative or beyond
                63 bits.
        """

@final
class NativeFramer:
    """Cuts frames out of a byte stream; see :class:`cobotwire.codec.interface.Framer`.

    Made by :meth:`NativeCodec.framer`. Not for use by two threads at once.
    """

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; return the events that have become certain, in the order of the stream."""

    def flush(self) -> list[Event]:
        """Reject the incomplete candidate, because the line is idle.

        Return it and the events after it.
        """

    @property
    def pending(self) -> int:
        """The number of fed bytes that no event covers yet: fewer than the longest frame has."""

    @property
    def fed(self) -> int:
        """The number of bytes fed since the framer was created."""

    @property
    def counters(self) -> Counters:
        """The counts since the framer was made."""

@final
class AlarmClock:
    """A descriptor that becomes readable at a given time, for event loops. Only on Linux."""

    def __new__(cls) -> AlarmClock:
        """Create a clock that is not set.

        Raises:
            OSError: the process has too many descriptors.
        """

    def fileno(self) -> int:
        """Return the descriptor, which is open as long as this object exists."""

    def set(self, due: float | None, /) -> None:
        """Make it readable from a time of ``time.monotonic()`` on, and not before; None: never.

        Raises:
            OSError: the time is beyond what the system can count.
        """

@final
class NativeFrame:
    """A legal frame; a virtual subclass of :class:`cobotwire.codec.events.Frame`.

    It keeps its bytes, not its message, and decodes them at each use.
    """

    @property
    def offset(self) -> int:
        """The offset of the frame in the stream."""

    @property
    def data(self) -> bytes:
        """The whole frame, from header to check."""

    @property
    def command(self) -> int:
        """The command id of the frame."""

    def decode(
        self, direction: Direction | None = None, *, of: str | None = None
    ) -> DecodedMessage:
        """Return what ``codec.decode(direction, frame.data, of=of)`` returns.

        The frame is not validated again; see :meth:`cobotwire.codec.events.Frame.decode`.

        Raises:
            ProtocolError: it is not a frame of that direction or command, or a field holds a value
                that the edition does not allow, or the edition lacks its id.
            UsageError: ``of`` names no command.
        """

    @property
    def message(self) -> DecodedMessage:
        """The decoded message: the first one that allows the values, requests first.

        Raises:
            ProtocolError: as :meth:`decode`.
        """

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of the message, one for each field.

        Raises:
            ProtocolError: as :meth:`decode`.
        """

    def __eq__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class NativeColumnReader:
    """Decodes a stream into columns; see :class:`cobotwire.codec.interface.ColumnReader`.

    Made by :meth:`NativeCodec.column_reader`. While a thread uses it, every use by another one
    raises UsageError and changes nothing.
    """

    def feed(self, data: Data) -> Columns:
        """Take bytes; return the rows that have become certain since the last call."""

    def flush(self) -> Columns:
        """Stop waiting for more bytes; return the remaining rows and noise."""

    @property
    def pending(self) -> int:
        """The number of fed bytes that wait for more: fewer than the longest frame has."""

@final
class NativeCaptureReader:
    """Reads a pcapng recording, piece by piece, into columns with times.

    ``codec_of`` is called with the name, the description and the speed of an interface when a
    direction of that interface has its first packet; an exception that it raises ends reading.
    While a thread uses the reader, every use by another one raises UsageError and changes nothing.
    """

    def __new__(
        cls,
        codec_of: Callable[[bytes, bytes, int], NativeCodec],
        listening: Listening,
        raw: bool,
    ) -> NativeCaptureReader:
        """Begin a file; ``listening`` says which messages packets of unknown direction hold."""

    def add(self, data: Data) -> None:
        """Take the next bytes of the file; after damage or the end they are ignored."""

    def end(self) -> None:
        """End the file, and stop waiting for more bytes."""

    def streams(self) -> list[tuple[int, int, Columns, list[Memory], Memory, Memory]]:
        """Return what was found in each stream since the last call.

        For each stream: the index of its interface; its direction (0 unknown, 1 received, 2 sent);
        its columns; the times of each of their rows, of the rejected frames and of the noise.
        """

    @property
    def interfaces(self) -> tuple[tuple[bytes, bytes, int], ...]:
        """The name, description and speed of each interface that the file describes so far."""

    @property
    def status(
        self,
    ) -> tuple[bytes, int, bool, int | None, tuple[int, str, list[int]] | None]:
        """The name of the program that wrote the file, and how far it was read.

        How far: the number of bytes read; whether the recording was finished; the offset of the
        incomplete block at the end; and the damage: its offset, its kind and its numbers.
        """

@final
class NativeSummary:
    """Counts the messages and the noise of a stream, and writes lines of JSON.

    ``bus`` says how packets of the servo bus are read. ``texts`` are the first four texts of
    :class:`cobotwire.diagnose.stream_summary.LineTexts`; None: no lines are written.
    :class:`cobotwire.diagnose.stream_summary.StreamSummary` uses it.
    """

    def __new__(
        cls,
        codec: NativeCodec,
        listening: Listening,
        accept_unknown: bool,
        bus: Vocabulary,
        texts: tuple[Any, ...] | None,
    ) -> NativeSummary:
        """Start a stream."""

    def feed(self, data: bytes, rest: Rest) -> list[Noise | tuple[int, int, str]]:
        """Take bytes; return the items that are certain and not only counted, in stream order.

        An item is noise to diagnose, or ``(offset, size, lines)`` of frames and of diagnosed noise.
        ``rest`` does the work that is left to Python; it is called before each complete span of
        noise, with the items that precede the span.
        """

    def flush(self, rest: Rest) -> list[Noise | tuple[int, int, str]]:
        """Report everything, because no more bytes follow."""

    @property
    def counters(self) -> Counters:
        """The counts of the framer."""

    @property
    def messages(self) -> list[tuple[int, Command | None, int]]:
        """For each message its id, its command and the number of frames, in order of appearance.

        The command is None if no message is legal.
        """

    @property
    def findings(self) -> list[tuple[str, int, int]]:
        """The noise that was only counted: kind, number of findings and of bytes."""

@final
class Memory(Buffer):
    """Numbers in memory, for memoryviews, NumPy and Arrow; read-only."""

def read_within(descriptor: int, timeout: float, alarm: int, /) -> bytes | None:
    """Read received bytes from a non-blocking descriptor, as soon as there are any.

    Returns:
        The bytes, empty at the end of the data; None if nothing came within ``timeout`` seconds, or
        before ``alarm`` became readable. A timeout of 0 or less does not wait, and needs no alarm.

    Raises:
        OSError: the system cannot read it.
    """

def write_now(descriptor: int, data: bytes, /) -> int:
    """Write to a descriptor that never blocks; return how many bytes were taken at once.

    Raises:
        OSError: the system cannot write it.
    """
