"""Define the frame around the data bytes of a message: where its parts are, and what LEN counts."""

from __future__ import annotations

from typing import Literal, NamedTuple

from cobotwire.protocol.checks import ByteOrder, Check
from cobotwire.protocol.records import field, record

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


@record(frozen=True, slots=True)
class FrameFormat:
    """``header``, the fixed parts in the order of ``layout``, data, ``check``, ``footer``.

    The fixed parts are the address byte, LEN and the command id. If ``addresses`` is empty, frames
    have no address byte; otherwise it is one of them, and the first one is sent unless the caller
    chooses another. LEN is the size of the parts in ``counted``. ``check`` is None if only the
    footer detects damage.

    Without ``reply_has_id`` a reply carries no command id: its data take the id's place, so ``id``
    is the number there. The id then is the last fixed part, and a reply has at least its size.

    Attributes:
        length_at: the offset of LEN.
        id_at: the offset of the command id.
        address_at: the offset of the address byte; None if there is none.
        data_at: the offset of the data after a command id.
        head_size: the number of bytes up to LEN and id, whichever is later.
        overhead: the number of bytes that LEN does not count.
        check_size: the number of bytes of check and footer.
        check_from: the offset of the first byte that the check covers.
    """

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
    length_at: int = field(init=False, repr=False, compare=False)
    id_at: int = field(init=False, repr=False, compare=False)
    address_at: int | None = field(init=False, repr=False, compare=False)
    data_at: int = field(init=False, repr=False, compare=False)
    head_size: int = field(init=False, repr=False, compare=False)
    overhead: int = field(init=False, repr=False, compare=False)
    check_size: int = field(init=False, repr=False, compare=False)
    check_from: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        sizes = {
            "header": len(self.header),
            "address": 1 if self.addresses else 0,
            "length": self.length_number.width,
            "command": self.id_number.width,
            "data": 0,
            "check": self.check.width if self.check else 0,
            "footer": len(self.footer),
        }
        offsets, at = {"header": 0}, sizes["header"]
        for part in self.layout:
            offsets[part] = at
            at += sizes[part]
        offsets["data"] = at
        derived = {
            "length_at": offsets["length"],
            "id_at": offsets["command"],
            "address_at": offsets["address"] if self.addresses else None,
            "data_at": at,
            "head_size": max(
                offsets["length"] + sizes["length"], offsets["command"] + sizes["command"]
            ),
            "overhead": sum(sizes.values()) - sum(sizes[part] for part in set(self.counted)),
            "check_size": sizes["check"] + sizes["footer"],
            "check_from": offsets[self.check.covers_from] if self.check else 0,
        }
        for name, value in derived.items():
            object.__setattr__(self, name, value)

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
