"""What a codec is: the one interface behind which the reference and the native codec stand.

Values are positional, one a field of the layout: an ``int`` where the scale is one, a ``float``
where it is not, a tuple of these for a ``many`` field.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, Protocol

from cobotwire.table import Command, Direction, Layout, Table

Listening = Literal["request", "reply", "both"]
NoiseReason = Literal[
    "no-header", "bad-address", "bad-length", "unknown-id", "bad-check", "truncated"
]


class Frame(NamedTuple):
    """A whole, legal frame with its command id; ``offset`` is where it starts in the stream."""

    offset: int
    data: bytes
    command: int


class Noise(NamedTuple):
    """Bytes that belong to no frame; every one of them was refuted for the same reason."""

    offset: int
    data: bytes
    reason: NoiseReason


Event = Frame | Noise


class Message(NamedTuple):
    """A decoded frame; ``address`` is its address byte, None where the format has none."""

    command: Command
    direction: Direction
    layout: Layout
    values: tuple[Any, ...]
    address: int | None = None

    @property
    def fields(self) -> dict[str, Any]:
        """The values by field name. A field that an optional form leaves out is not in it."""
        return {field.name: value for field, value in zip(self.layout.fields, self.values)}


class Framer(Protocol):
    """Cuts frames out of a byte stream; see the law of framing in ``docs/framing.md``."""

    def feed(self, data: bytes | bytearray | memoryview) -> list[Event]:
        """Take bytes; give what is certain by now, in the order of the stream."""
        ...

    def flush(self) -> list[Event]:
        """Refute what still waits (the line has been idle): a true frame behind it comes now."""
        ...

    @property
    def pending(self) -> int:
        """Bytes fed that no event covers yet; less than the longest frame."""
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
