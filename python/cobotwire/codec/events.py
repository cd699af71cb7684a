"""What a framer gives: frames, and the noise between them."""

from __future__ import annotations

from abc import ABCMeta
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

from cobotwire.errors import UsageError
from cobotwire.table import Command, Direction, Layout

NoiseReason = Literal[
    "no-header", "bad-address", "bad-length", "unknown-id", "bad-check", "truncated"
]


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


class Frame(metaclass=ABCMeta):  # noqa: B024  (the native class registers as one of its kind)
    """A whole, legal frame with its command id; ``offset`` is where it starts in the stream.

    What it says is read when it is first asked for. A framer that listens to both directions reads
    it as a request where it can be one. The native codec's frames are of this kind as well.
    """

    __slots__ = ("_message", "_read", "command", "data", "offset")

    def __init__(
        self, offset: int, data: bytes, command: int, read: Callable[[bytes], Message] | None = None
    ) -> None:
        self.offset = offset
        self.data = data
        self.command = command
        self._read = read
        self._message: Message | None = None

    @property
    def message(self) -> Message:
        """What it says, as the first message that allows its values.

        Raises:
            ProtocolError: a field holds a value that the edition does not allow, or the framer was
                told to accept ids that the edition lacks, and this is one.
            UsageError: no framer gave this frame.
        """
        if self._message is None:
            if self._read is None:
                raise UsageError("frame", self, "one that a framer gave")
            self._message = self._read(self.data)
        return self._message

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of its message, one a field.

        Raises:
            ProtocolError, UsageError: as ``message``.
        """
        return self.message.values

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Frame):
            return NotImplemented
        mine = (self.offset, self.command, self.data)
        return mine == (other.offset, other.command, other.data)

    def __hash__(self) -> int:
        return hash((self.offset, self.command, self.data))

    def __repr__(self) -> str:
        data = self.data.hex(" ").upper()
        return f"<Frame {data} at {self.offset}>"


class Noise(NamedTuple):
    """Bytes that belong to no frame; every one of them was refuted for the same reason."""

    offset: int
    data: bytes
    reason: NoiseReason


Event = Frame | Noise


class Counters(NamedTuple):
    """What came over a line since the framer was made. Chunks do not show in it.

    ``bytes`` were fed, the pending ones included. ``frames`` are counted by command id, ``noise``
    in bytes by reason; what never came is not listed. ``resyncs``: how often a frame came right
    behind noise.
    """

    bytes: int
    frames: dict[int, int]
    noise: dict[NoiseReason, int]
    resyncs: int
