"""Define the events that a framer returns: frames, and the noise between them."""

from __future__ import annotations

from abc import ABCMeta
from typing import Any, Literal, NamedTuple, Protocol

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Direction, Variant

NoiseReason = Literal[
    "no-header", "bad-address", "bad-length", "unknown-id", "bad-check", "truncated"
]


class DecodedMessage(NamedTuple):
    """A decoded frame; ``address`` is its address byte, None if the format has none."""

    command: Command
    direction: Direction
    variant: Variant
    values: tuple[Any, ...]
    address: int | None = None

    @property
    def fields(self) -> dict[str, Any]:
        """The values by field name, without fields that this variant of the message leaves out."""
        return dict(zip(self.variant.names, self.values))

    @property
    def typed(self) -> Request[Any] | Reply[Any]:
        """The message as an object of its own type, for ``match`` and attribute access."""
        command = self.command
        if self.direction == "request":
            return command.request_type.from_fields(self.fields)
        assert command.reply_type is not None, "a decoded reply has a type"
        return command.reply_type.from_fields(self.fields)


class Read(Protocol):
    """Decodes a frame that a framer returned.

    Without a direction, it tries every direction that the framer listened to.
    """

    def __call__(
        self, data: bytes, direction: Direction | None = None, of: str | None = None
    ) -> DecodedMessage:
        """Return the frame decoded as the first message that allows its values."""
        ...


class Frame(metaclass=ABCMeta):  # noqa: B024  (the native class registers as a virtual subclass)
    """A legal frame with its command id; ``offset`` is its start in the stream.

    The message is decoded on first use. Frames of the native codec are instances of this class too;
    each use decodes the bytes again.
    """

    __slots__ = ("_message", "_read", "command", "data", "offset")

    def __init__(self, offset: int, data: bytes, command: int, read: Read | None = None) -> None:
        self.offset = offset
        self.data = data
        self.command = command
        self._read = read
        self._message: DecodedMessage | None = None

    def decode(
        self, direction: Direction | None = None, *, of: str | None = None
    ) -> DecodedMessage:
        """Return what ``codec.decode(direction, frame.data, of=of)`` returns.

        The framer has checked LEN and the check, so they are not checked again. Without a
        direction, every direction that the framer listened to is tried, requests first; the result
        is the first message that allows the values.

        Raises:
            ProtocolError: the frame does not belong to that direction or command; a field holds a
                value that the edition does not allow; or the framer accepted an id that the edition
                lacks.
            UsageError: ``of`` names no command, or no framer returned the frame.
        """
        if self._read is None:
            raise UsageError("frame", self, message=f"{self!r} did not come from a framer")
        return self._read(self.data, direction, of)

    @property
    def message(self) -> DecodedMessage:
        """The decoded message: the first one that allows the values, requests first.

        Raises:
            ProtocolError, UsageError: as :meth:`decode`.
        """
        if self._message is None:
            self._message = self.decode()
        return self._message

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of the message, one for each field.

        Raises:
            ProtocolError, UsageError: as :meth:`decode`.
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
    """Bytes that belong to no frame, all rejected for the same reason."""

    offset: int
    data: bytes
    reason: NoiseReason


Event = Frame | Noise


class Counters(NamedTuple):
    """The counts of a framer since it was created; they do not depend on the chunks.

    ``bytes`` counts the fed bytes, pending bytes included. ``frames`` counts frames by command id,
    and ``noise`` counts bytes by reason; both omit counts of 0. ``resyncs`` counts the frames that
    directly followed noise.
    """

    bytes: int
    frames: dict[int, int]
    noise: dict[NoiseReason, int]
    resyncs: int
