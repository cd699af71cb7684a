"""Print packets, recorded or live, for people and as JSON."""

from __future__ import annotations

from typing import Any

from cobotwire.capture import Packet
from cobotwire.cli.shared.output import as_hex, fold
from cobotwire.cli.shared.recordings import ARROWS, seconds_column
from cobotwire.codec.interface import Codec
from cobotwire.diagnose.explain import format_message
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.printable import printable


def meaning_of(packet: Packet, codec: Codec) -> str:
    """Return the meaning of a packet, for people."""
    if packet.kind == "noise":
        return f"noise ({printable(packet.reason)})"
    if packet.kind == "bytes" or packet.direction == "unknown":
        return "bytes"
    try:
        return format_message(
            codec.decode("request" if packet.direction == "sent" else "reply", packet.data)
        )
    except ProtocolError as error:
        # The frame was recorded with another edition.
        return str(error)


def _pause(packet: Packet) -> str:
    if not packet.pieces:
        return ""
    seconds = (packet.pieces[-1].time_ns - packet.time_ns) / 1e9
    return f"   (in {len(packet.pieces)} pieces, the last after {seconds:.6f} s)"


def packet_line(packet: Packet, after: float | None, meaning: str, label: str = "") -> str:
    """Return the line of a packet: seconds since the start, direction, bytes, meaning."""
    when, data = f"{seconds_column(after)}{label}", as_hex(packet.data)
    return fold(f"{when} {ARROWS[packet.direction]} {data}   {meaning}{_pause(packet)}")


def packet_as_json(packet: Packet, url: str, after: float | None, meaning: str) -> dict[str, Any]:
    """Return a packet of a port as values of JSON."""
    pieces = [
        {"size": size, "after": (time_ns - packet.time_ns) / 1e9} for size, time_ns in packet.pieces
    ]
    return {
        "time_ns": None if after is None else packet.time_ns,
        "after": after,
        "url": url,
        "direction": packet.direction,
        "kind": packet.kind,
        "reason": packet.reason,
        "data": as_hex(packet.data),
        "meaning": meaning,
        "pieces": pieces,
    }
