"""Rules for frame formats: their keys agree with each other, and the codecs support them."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.catalogue import WIDTHS
from cobotwire_codegen.errors import nearest
from cobotwire_codegen.language.limits import (
    DIRECTION,
    MORE_PARTS,
    NO_COMMAND,
    NO_HEADER,
    NO_LENGTH,
    STUFFING,
    Limit,
)
from cobotwire_codegen.model import Frame

_FIXED = ("address", "length", "command")
_PARTS = ("header", *_FIXED, "data", "check", "footer")
# The highest LEN of two bytes that the codecs support.
_LONGEST = 0x4000

# The third byte of MSP, after `$M` in version 1 and `$X` in version 2.
_DIRECTIONS = (b"<", b">", b"!")


def beyond_language(frame: Frame, stuffing: bool | None) -> Iterator[tuple[str, Limit]]:
    """Yield features of frames that a spec cannot state, each after words that name the evidence.

    ``stuffing`` is the spec's statement about byte stuffing.
    """
    shown = f"the header {frame.header.hex(' ').upper()}"
    # One byte at both ends, as in SLIP, COBS and HDLC.
    delimited = len(frame.header) == 1 and frame.header == frame.footer
    if not frame.header:
        yield "", NO_HEADER
    start, third = frame.header[:2], frame.header[2:3]
    if start == b"$M" and third in _DIRECTIONS:
        yield f"{shown} has a direction; ", DIRECTION
    if start == b"$X" and (third or bytes(frame.address_values[:1])) in _DIRECTIONS:
        yield f"{shown} is that of MSP v2, with a flag before CMD; ", MORE_PARTS
    if stuffing:
        yield "", STUFFING
    elif stuffing is None and (delimited or frame.header.startswith(b"\xff\xff\xfd")):
        advice = "if the device inserts no bytes, write `stuffing: false`"
        yield f"{shown} suggests byte stuffing; {advice}; ", STUFFING
    if other := [part for part in frame.layout if part not in _FIXED]:
        yield f"layout cannot have {other[0]}{nearest(other[0], _FIXED)}; ", MORE_PARTS
    else:
        if "length" not in frame.layout or not frame.counted:
            yield "", NO_LENGTH
        if "command" not in frame.layout:
            yield "", NO_COMMAND


def mistakes(frame: Frame) -> Iterator[str]:
    """Yield what is wrong with a frame format, as sentences."""
    if len(frame.header) > 4:
        yield "the header must have one to four bytes"
    if frame.check is None and len(frame.footer) != 1:
        yield "the footer must have one byte, since `check` is footer"
    if len(frame.footer) > 2:
        yield "the footer must have at most two bytes"
    silent = [address.replies == "none" for address in frame.addresses]
    if silent[:1] == [True] and not all(silent):
        first = f"the first address, {frame.addresses[0].name}, is the default"
        yield f"{first}, but has no replies; list another one first"
    yield from _layout(frame)
    yield from _counted(frame)
    yield from _check(frame)
    most = _LONGEST if frame.length_number.width == 2 else 255
    room = most - frame.length(0)
    if frame.maximum_data > room:
        yield f"maximum_data of the frame is {frame.maximum_data}; allowed: 0..{room}"


def _layout(frame: Frame) -> Iterator[str]:
    given = sorted(frame.layout)
    wanted = ["address", "command", "length"] if frame.address_values else ["command", "length"]
    if given not in (wanted, ["address", "command", "length"]):
        yield f"layout must have each of {', '.join(wanted)} once"
    elif frame.layout[-1] == "address":
        yield "layout must end with length or command"
    elif not frame.replies_have_command and frame.layout[-1] != "command":
        yield "layout must end with command, since replies have data in its place"


def _counted(frame: Frame) -> Iterator[str]:
    """Report parts that LEN cannot count."""
    for part in frame.counted:
        if part not in _PARTS:
            yield f"length_counts cannot have {part}; allowed: {', '.join(_PARTS)}"
        elif part != "data" and not frame.sizes[part]:
            yield f"length_counts has {part}, but frames have none"
    if "data" not in frame.counted or len(set(frame.counted)) < len(frame.counted):
        yield "length_counts must have data, and no part twice"
    if not frame.replies_have_command and "command" not in frame.counted:
        yield "length_counts must have command, since replies have data in its place"


def _check(frame: Frame) -> Iterator[str]:
    check = frame.check
    if check is None:
        return
    widths = (-(-check.crc.width // 8),) if check.crc else WIDTHS[check.word]
    if check.width not in widths:
        allowed = " or ".join(map(str, widths))
        yield f"check_bytes is {check.width}; allowed for {check.word}: {allowed}"
    if check.covers_from == "data" and not frame.replies_have_command:
        yield "check_from cannot be data, since the data of replies start earlier"
    if check.covers_from == "address" and not frame.address_values:
        yield "check_from is address, but frames have none"
