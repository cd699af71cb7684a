"""Define the frame around the data bytes of a message: where its parts are, and what LEN counts."""

from __future__ import annotations

from functools import cached_property
from typing import Literal, NamedTuple

from cobotwire.protocol.checks import ByteOrder, Check

FixedPart = Literal["address", "length", "command"]
CountedPart = Literal["header", "address", "length", "command", "data", "check", "footer"]
Direction = Literal["request", "reply"]

_LAYOUT: tuple[FixedPart, ...] = ("address", "length", "command")
_COUNTED: tuple[CountedPart, ...] = ("command", "data", "check", "footer")


class Unsigned(NamedTuple):
    """An unsigned number of a frame: LEN or the command id."""

    width: int = 1
    order: ByteOrder = "big"


_BYTE = Unsigned()


class _FrameFields(NamedTuple):
    header: bytes
    footer: bytes
    maximum_length: int
    check: Check | None = None
    addresses: tuple[int, ...] = ()
    layout: tuple[FixedPart, ...] = _LAYOUT
    counted: tuple[CountedPart, ...] = _COUNTED
    length_number: Unsigned = _BYTE
    id_number: Unsigned = _BYTE
    reply_has_id: bool = True


class FrameFormat(_FrameFields):
    """``header``, the fixed parts in the order of ``layout``, data, ``check``, ``footer``.

    The fixed parts are the address byte, LEN and the command id. If ``addresses`` is empty, frames
    have no address byte; otherwise it is one of them, and the first one is sent unless the caller
    chooses another. LEN is the size of the parts in ``counted``. ``check`` is None if only the
    footer detects damage.

    Without ``reply_has_id`` a reply carries no command id: its data begin where the id would be,
    and ``read_id`` returns their first bytes. The id is then the last fixed part, and no reply has
    fewer data bytes than an id.
    """

    @cached_property
    def _sizes(self) -> dict[CountedPart, int]:
        return {
            "header": len(self.header),
            "address": 1 if self.addresses else 0,
            "length": self.length_number.width,
            "command": self.id_number.width,
            "data": 0,
            "check": self.check.width if self.check else 0,
            "footer": len(self.footer),
        }

    def _offset(self, part: CountedPart) -> int:
        """Return the offset of the header, of a fixed part, or of the data after them."""
        order: tuple[CountedPart, ...] = ("header", *self.layout, "data")
        return sum([self._sizes[each] for each in order[: order.index(part)]])

    @cached_property
    def length_at(self) -> int:
        """The offset of LEN."""
        return self._offset("length")

    @cached_property
    def id_at(self) -> int:
        """The offset of the command id."""
        return self._offset("command")

    @cached_property
    def address_at(self) -> int | None:
        """The offset of the address byte; None in a format without addresses."""
        return self._offset("address") if self.addresses else None

    @cached_property
    def data_at(self) -> int:
        """The offset of the data after a command id."""
        return self._offset("data")

    @cached_property
    def head_size(self) -> int:
        """The number of bytes up to LEN and id, whichever is later."""
        return max(self.length_at + self.length_number.width, self.id_at + self.id_number.width)

    @cached_property
    def overhead(self) -> int:
        """The number of bytes that LEN does not count."""
        return sum([size for part, size in self._sizes.items() if part not in self.counted])

    @cached_property
    def check_size(self) -> int:
        """The number of bytes of check and footer."""
        return self._sizes["check"] + self._sizes["footer"]

    @cached_property
    def check_from(self) -> int:
        """The offset of the first byte that the check covers."""
        return self._offset(self.check.covers_from) if self.check else 0

    def length(self, data_size: int, direction: Direction = "request") -> int:
        """Return LEN of a frame with ``data_size`` data bytes."""
        return self.data_start(direction) + data_size + self.check_size - self.overhead

    def data_start(self, direction: Direction) -> int:
        """Return the offset of the data bytes in a frame of that direction."""
        return self.data_at if self.has_id(direction) else self.id_at

    def has_id(self, direction: Direction) -> bool:
        """Return whether frames of that direction carry a command id."""
        return self.reply_has_id or direction == "request"

    def read_length(self, frame: bytes, start: int = 0) -> int:
        """Return LEN of the frame that begins at ``start``."""
        at, number = start + self.length_at, self.length_number
        return int.from_bytes(frame[at : at + number.width], number.order)

    def read_id(self, frame: bytes, start: int = 0) -> int:
        """Return the command id of the frame that begins at ``start``."""
        at, number = start + self.id_at, self.id_number
        return int.from_bytes(frame[at : at + number.width], number.order)

    def with_length(self, frame: bytes, length: int) -> bytes:
        """Return the frame with another LEN, which is cut to the size of LEN."""
        return _replaced(frame, self.length_at, self.length_number, length)

    def with_id(self, frame: bytes, id: int) -> bytes:
        """Return the frame with another command id, which is cut to the size of an id."""
        return _replaced(frame, self.id_at, self.id_number, id)

    def data(self, frame: bytes, direction: Direction = "request") -> bytes:
        """Return the data bytes of a frame, before the check."""
        return frame[self.data_start(direction) : len(frame) - self.check_size]

    def address(self, frame: bytes) -> int | None:
        """Return the address byte of a frame; None if the format has no addresses."""
        return None if self.address_at is None else frame[self.address_at]

    def start(
        self, id: int, length: int, address: int | None = None, direction: Direction = "request"
    ) -> bytes:
        """Return the start of a frame, up to its data."""
        parts: dict[FixedPart, bytes] = {
            "address": bytes(self.addresses[:1]) if address is None else bytes([address])
        }
        width, order = self.length_number
        parts["length"] = length.to_bytes(width, order)
        width, order = self.id_number
        parts["command"] = id.to_bytes(width, order) if self.has_id(direction) else b""
        return self.header + b"".join([parts[part] for part in self.layout])

    def enclose(
        self, id: int, data: bytes, address: int | None = None, direction: Direction = "request"
    ) -> bytes:
        """Return the frame around some data bytes."""
        body = self.start(id, self.length(len(data), direction), address, direction) + data
        return body + self.end(body)

    def end(self, body: bytes) -> bytes:
        """Return check and footer, which must follow ``body``: all bytes from the header on."""
        if self.check is None:
            return self.footer
        return self.check.of(body[self.check_from :]) + self.footer


def _replaced(frame: bytes, at: int, form: Unsigned, number: int) -> bytes:
    new = (number % (1 << 8 * form.width)).to_bytes(form.width, form.order)
    return frame[:at] + new + frame[at + form.width :]
