"""Encode the blocks of a pcapng file that a serial recording needs.

The format is IETF draft-ietf-opsawg-pcapng. A block consists of its type, its length, its body
padded to four bytes, and its length again. A body ends with options. Each option is a code, a
length, and a value padded to four bytes.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable

SECTION, INTERFACE, SIMPLE_PACKET, STATISTICS, PACKET = 0x0A0D0D0A, 1, 3, 5, 6
OBSOLETE_PACKET = 2
BYTE_ORDER_MAGIC = 0x1A2B3C4D
VERSION = 1, 0
SECTION_LENGTH_UNKNOWN = -1

# Option codes. The first two mean the same in every block.
END, COMMENT = 0, 1
SECTION_APPLICATION = 4
INTERFACE_NAME, INTERFACE_DESCRIPTION, INTERFACE_SPEED = 2, 3, 8
INTERFACE_RESOLUTION, INTERFACE_OFFSET = 9, 14
# The size of a speed and of an offset.
NUMBER_SIZE = 8
PACKET_FLAGS = 2
STATISTICS_START, STATISTICS_END, STATISTICS_RECEIVED = 2, 3, 4

# The two lowest bits of a packet's flags.
INBOUND, OUTBOUND = 1, 2
# Link types reserved for private use: USER0 to USER15. USER12 is less likely to be in use than the
# first ones.
USER_LINK_TYPES = range(147, 163)
LINK_TYPE = 159
NANOSECONDS = 9

Option = tuple[int, bytes]


def _padded(data: bytes) -> bytes:
    return data + bytes(-len(data) % 4)


def _options(options: Iterable[Option]) -> bytes:
    encoded = [struct.pack("<HH", code, len(value)) + _padded(value) for code, value in options]
    return b"".join([*encoded, struct.pack("<HH", END, 0)]) if encoded else b""


def text(code: int, value: str) -> list[Option]:
    """Return a text option, or no option for an empty text. A text that is too long is cut."""
    # The length field has 16 bits; the cut must not leave half a character.
    data = value.encode("utf-8", "replace")[:0xFFFF].decode("utf-8", "ignore").encode()
    return [(code, data)] if data else []


def _block(kind: int, body: bytes) -> bytes:
    size = struct.pack("<I", len(body) + 12)
    return struct.pack("<I", kind) + size + body + size


def section(application: str, comments: Iterable[str] = ()) -> bytes:
    """Return the block that begins a file; ``application`` names the program that writes it."""
    head = struct.pack("<IHHq", BYTE_ORDER_MAGIC, *VERSION, SECTION_LENGTH_UNKNOWN)
    options = [option for comment in comments for option in text(COMMENT, comment)]
    return _block(SECTION, head + _options([*options, *text(SECTION_APPLICATION, application)]))


def interface(name: str, description: str, speed: int, start_seconds: int = 0) -> bytes:
    """Return the block that describes an interface.

    Its packets have nanosecond time stamps, which count from ``start_seconds`` after 1970.
    """
    options = text(INTERFACE_NAME, name) + text(INTERFACE_DESCRIPTION, description)
    if speed:
        options.append((INTERFACE_SPEED, struct.pack("<Q", speed)))
    options.append((INTERFACE_RESOLUTION, bytes([NANOSECONDS])))
    if start_seconds:
        options.append((INTERFACE_OFFSET, struct.pack("<q", start_seconds)))
    return _block(INTERFACE, struct.pack("<HHI", LINK_TYPE, 0, 0) + _options(options))


def _time(time_ns: int) -> bytes:
    return struct.pack("<II", time_ns >> 32, time_ns & 0xFFFFFFFF)


def packet(index: int, time_ns: int, data: bytes, flags: int, comment: str) -> bytes:
    """Return the block of one packet of the interface with that index."""
    head = struct.pack("<I", index) + _time(time_ns) + struct.pack("<II", len(data), len(data))
    options = [*text(COMMENT, comment), (PACKET_FLAGS, struct.pack("<I", flags))]
    return _block(PACKET, head + _padded(data) + _options(options))


def statistics(index: int, start_ns: int, end_ns: int, packets: int) -> bytes:
    """Return the block that ends an interface's recording; a recording without it is unfinished."""
    options: list[Option] = [
        (STATISTICS_START, _time(start_ns)),
        (STATISTICS_END, _time(end_ns)),
        (STATISTICS_RECEIVED, struct.pack("<Q", packets)),
    ]
    return _block(STATISTICS, struct.pack("<I", index) + _time(end_ns) + _options(options))


def end_mark(index: int, end_ns: int) -> bytes:
    """Return statistics without numbers: they only mark an interface's recording as finished."""
    return _block(STATISTICS, struct.pack("<I", index) + _time(end_ns))
