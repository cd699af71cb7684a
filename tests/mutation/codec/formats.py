"""Codecs with wrong frames where frames have a check value, or an address."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.protocol.checks import Check
from cobotwire.protocol.table import Table
from mutation.codec.answers import Make, decoding, encoding
from mutation.device.cells import checked


def wrong_formats(table: Table) -> Iterator[tuple[str, Make]]:
    """Yield each fault in the parts of a frame that not every edition has."""
    check = table.frame.check
    if check is not None:
        yield "computes the check from another byte on", _check_with(_other_start)
    if check is not None and check.width > 1:
        yield "swaps the bytes of the check", _check_with(_other_order)
    if check is not None and check.crc is not None:
        yield "begins the CRC with another value", _check_with(_other_init)
    if table.frame.addresses:
        yield "ignores the address", decoding(_right_address)
        yield "writes an address that the edition lacks", encoding(_unused_address)


def _check_with(change: Callable[[Check], Check]) -> Make:
    """Make a codec with another check."""

    def make(table: Table) -> OurCodec:
        assert table.frame.check is not None, "only formats with a check have this fault"
        frame = table.frame._replace(check=change(table.frame.check))
        return OurCodec(ReferenceCodec(table._replace(frame=frame)))

    return make


def _other_start(check: Check) -> Check:
    return check._replace(covers_from="data" if check.covers_from == "command" else "command")


def _other_order(check: Check) -> Check:
    return check._replace(order="little" if check.order == "big" else "big")


def _other_init(check: Check) -> Check:
    assert check.crc is not None, "only a CRC begins with a value"
    return check._replace(crc=check.crc._replace(init=check.crc.init ^ 1))


def _right_address(table: Table, data: bytes) -> bytes:
    """Return the bytes with an address of the edition in place of another one."""
    at = table.frame.address_at
    if at is None or len(data) <= at or data[at] in table.frame.addresses:
        return data
    return _addressed(table, data, table.frame.addresses[0])


def _unused_address(table: Table, data: bytes) -> bytes:
    taken = table.frame.addresses
    return _addressed(table, data, next(byte for byte in range(256) if byte not in taken))


def _addressed(table: Table, data: bytes, address: int) -> bytes:
    at = table.frame.address_at
    assert at is not None, "only formats with addresses have this fault"
    return checked(table.frame, data[:at] + bytes([address]) + data[at + 1 :])
