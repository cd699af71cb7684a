"""The Rust codec's binary: what ``cobotwire.codec.native`` gives out.

It reads a table's objects once, when a codec is made, and converts; what is legal is decided in
``rust/core``, and what an error says in ``cobotwire.codec.refusal``.
"""

from collections.abc import Sequence
from typing import Any, Literal, final

from cobotwire.codec.interface import Event, Listening, Message
from cobotwire.table import Direction, Table

__all__ = ["NativeCodec", "NativeFramer"]

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

@final
class NativeFramer:
    """Cuts frames out of a byte stream; see :class:`cobotwire.codec.interface.Framer`.

    Made by :meth:`NativeCodec.framer`. Not for use by two threads at once.
    """

    def feed(self, data: bytes | bytearray | memoryview) -> list[Event]:
        """Take bytes; give what is certain by now, in the order of the stream."""

    def flush(self) -> list[Event]:
        """Refute what still waits (the line has been idle): a true frame behind it comes now."""

    @property
    def pending(self) -> int:
        """Bytes fed that no event covers yet; less than the longest frame."""
