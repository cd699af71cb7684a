"""Take a frame apart into numbers, so that any can be changed; classify what is not a request."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal, get_args

from cobotwire.codec.interface import DecodedMessage
from cobotwire.protocol.addresses import devices_of
from cobotwire.protocol.fields import Case, Field, RawRows, Variant
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.table import Table


@dataclass(frozen=True, slots=True)
class Cell:
    """One number on the wire: its encoding and its raw value."""

    number: Number
    raw: int

    @property
    def data(self) -> bytes:
        """The bytes of the number. Bits beyond its width are cut off, as in C."""
        return self.number.pack(self.raw)


def take_apart(frame: FrameFormat, message: DecodedMessage, data: bytes) -> list[list[Cell]]:
    """Return the cells of each field of a raw frame that was decoded as ``message``."""
    variant = message.variant
    rows = variant.unpack(frame.data(data))
    return [
        [Cell(number, raw) for number, raw in zip(_case(variant, field, rows).numbers, row)]
        for field, row in zip(variant.fields, rows)
    ]


def _case(variant: Variant, field: Field, rows: RawRows) -> Case:
    return variant.raw_case(field, rows) or field.cases[0]


def joined(fields: Iterable[Iterable[Cell]]) -> bytes:
    """Return the data bytes of a frame with these cells."""
    return b"".join(cell.data for cells in fields for cell in cells)


def framed(frame: FrameFormat, id: int, data: bytes, address: int | None = None) -> bytes:
    """Return a frame; if the format has addresses, ``address`` is by default the first one."""
    body = frame.start(id % 256, frame.length(len(data)) % 256, address) + data
    return body + frame.end(body)


def replier(table: Table, address: int | None) -> int | None:
    """Return the address of the simulated device that replies to a request to an address."""
    devices = [device.value for device in devices_of(table)]
    return address if address in devices or not devices else devices[0]


def checked(frame: FrameFormat, data: bytes) -> bytes:
    """Return a whole frame with the right check and footer at its end."""
    body = data[: len(data) - frame.check_size]
    return body + frame.end(body)


# Takes the table and a correct frame; returns a wrong one.
Edit = Callable[[Table, bytes], bytes]


def with_length(step: int) -> Edit:
    """Change only LEN, and the check that covers it."""

    def edit(table: Table, data: bytes) -> bytes:
        frame = table.frame
        return checked(frame, frame.with_length(data, frame.read_length(data) + step))

    return edit


def with_address(address: int) -> Edit:
    """Change only the address, and the check that covers it, if any."""

    def edit(table: Table, data: bytes) -> bytes:
        at = table.frame.address_at
        assert at is not None, "only formats with addresses have this fault"
        return checked(table.frame, data[:at] + bytes([address]) + data[at + 1 :])

    return edit


Stimulus = Literal[
    "noise", "truncated request", "bad footer", "wrong LEN", "unknown id", "illegal value"
]
STIMULI: tuple[Stimulus, ...] = get_args(Stimulus)


def kind_of(table: Table, noise: bytes) -> Stimulus:
    """Return what kind of malformed request a span of noise is, as a simple parser sees it."""
    frame = table.frame
    start = noise.find(frame.header)
    rest = noise[start + frame.length_at :] if start >= 0 else b""
    if len(rest) < 2:
        return "truncated request" if start >= 0 else "noise"
    length, id = rest[0], rest[1]
    sizes = {
        variant.size
        for command in table.commands
        if command.id == id
        for variant in command.request
    }
    if not sizes:
        return "unknown id"
    if length not in map(frame.length, sizes):
        return "wrong LEN"
    # The request is complete but ends with another byte, or it stops before its footer.
    return "bad footer" if len(rest) > length else "truncated request"
