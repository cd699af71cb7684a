"""Read captures of networks: classic pcap files, and pcapng files with packets of TCP.

Sources: draft-ietf-opsawg-pcap, tcpdump.org/linktypes.html, RFC 791, 8200 and 9293.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from functools import partial
from io import BytesIO
from ipaddress import ip_address
from typing import NamedTuple

from cobotwire.capture.block_encoding import USER_LINK_TYPES
from cobotwire.capture.block_file import BlockFile
from cobotwire.capture.block_parsing import Truncated, blocks_of, read_exactly
from cobotwire.capture.damage import LARGEST_BLOCK
from cobotwire.capture.foreign.reader import Chunk, ForeignFile, Reader
from cobotwire.capture.foreign.tcp import Connections, Segment
from cobotwire.capture.packet_parsing import PacketParser
from cobotwire.protocol.errors import CaptureError, UnreadableInput

# By the first four bytes of a classic file: its byte order, and the nanoseconds of its time unit.
_ORDERS = {
    struct.pack(order + "I", magic): (order, unit)
    for order in "<>"
    for magic, unit in ((0xA1B2C3D4, 1000), (0xA1B23C4D, 1))
}
_IPV4, _IPV6, _TCP = 0x0800, 0x86DD, 6
_VLAN = (0x8100, 0x88A8, 0x9100)
# IPv6 extension headers that may come before TCP.
_EXTENSIONS = (0, 43, 60)


class Frame(NamedTuple):
    """A packet as captured, with the header of its link."""

    time_ns: int
    link_type: int
    data: bytes


def _ethernet(data: bytes) -> bytes:
    at = 12
    while int.from_bytes(data[at : at + 2]) in _VLAN:
        at += 4
    return _payload(data, at)


def _payload(data: bytes, at: int) -> bytes:
    """Return what follows an EtherType, if it is IP."""
    return data[at + 2 :] if int.from_bytes(data[at : at + 2]) in (_IPV4, _IPV6) else b""


# For each link type: the IP packet in a frame. The header of a loopback packet states the IP
# version in the byte order of the machine. It is ignored, since the IP packet states its version
# too.
LINKS: dict[int, Callable[[bytes], bytes]] = {
    0: lambda data: data[4:],  # NULL: loopback of BSD and macOS
    108: lambda data: data[4:],  # LOOP: loopback of OpenBSD
    1: _ethernet,
    12: lambda data: data,  # RAW, as some systems number it
    101: lambda data: data,  # RAW
    228: lambda data: data,  # IPV4
    229: lambda data: data,  # IPV6
    113: lambda data: _payload(data, 14),  # LINUX_SLL
    276: lambda data: _payload(data[:2] + data[20:], 0),  # LINUX_SLL2
}


def _chunks(file: ForeignFile, frames: Iterator[Frame]) -> Iterator[Chunk]:
    connections = Connections(file)
    only_serial = True
    for frame in frames:
        if frame.link_type in USER_LINK_TYPES:
            yield Chunk(frame.data, "unknown", frame.time_ns)
            continue
        only_serial = False
        if frame.link_type not in LINKS:
            raise UnreadableInput(file.name, link_type_refused(frame.link_type))
        if segment := _segment(frame.time_ns, LINKS[frame.link_type](frame.data)):
            yield from connections.take(segment)
    if not only_serial:
        yield from connections.end()


def link_type_refused(link_type: int) -> str:
    """Return what is wrong with a link type, and what to do."""
    usb = link_type in (186, 189, 220, 249, 266)
    return (
        f"is a capture of {'USB' if usb else f'link type {link_type}'}, which is not read: "
        "print the payload as hex, such as tshark -r FILE -T fields -e "
        f"{'usb.capdata' if usb else 'data.data'} | cobotwire decode --hex -"
    )


def _segment(time_ns: int, packet: bytes) -> Segment | None:
    """Return the TCP segment in an IP packet; None if it holds none, or only a part of one."""
    version = packet[0] >> 4 if packet else 0
    if version == 4 and len(packet) >= 20:
        size = (packet[0] & 0xF) * 4
        # A fragment other than the first one has no TCP header; a first one lacks bytes, which
        # then count as lost.
        if packet[9] != _TCP or size < 20 or int.from_bytes(packet[6:8]) & 0x1FFF:
            return None
        source, target = packet[12:16], packet[16:20]
        # Network cards that divide segments themselves leave the length 0.
        total = int.from_bytes(packet[2:4]) or len(packet)
        content = packet[size:total]
    elif version == 6 and len(packet) >= 40:
        source, target = packet[8:24], packet[24:40]
        total = int.from_bytes(packet[4:6]) or len(packet)
        kind, content = packet[6], packet[40 : 40 + total]
        while kind in _EXTENSIONS and len(content) >= 8:
            kind, content = content[0], content[(content[1] + 1) * 8 :]
        if kind != _TCP:
            return None
    else:
        return None
    if len(content) < 20 or (offset := (content[12] >> 4) * 4) < 20:
        return None
    source_port, target_port, number, acknowledged = struct.unpack(">HHII", content[:12])
    names = str(ip_address(source)), source_port, str(ip_address(target)), target_port
    return Segment(time_ns, *names, number, acknowledged, content[13], content[offset:])


def _pcap(file: ForeignFile) -> Iterator[Chunk]:
    return _chunks(file, _pcap_frames(file))


def _pcap_frames(file: ForeignFile) -> Iterator[Frame]:
    read = partial(read_exactly, BlockFile[None](file.blocks))
    head, at = read(24), 24
    order, unit = _ORDERS.get(head[:4], ("<", 1000))
    if len(head) < 24 or head[:4] not in _ORDERS:
        raise UnreadableInput(file.name, "is not a whole pcap file: it needs a header of 24 bytes")
    link_type = struct.unpack(order + "I", head[20:])[0] & 0xFFFF
    while record := read(16):
        size = struct.unpack(order + "I", record[8:12])[0] if len(record) == 16 else 0
        if size > LARGEST_BLOCK:
            detail = f"is damaged at byte {at}: a packet has {size} bytes"
            raise UnreadableInput(file.name, detail)
        data = read(size)
        if len(record) < 16 or len(data) < size:
            file.missing.append(_cut_off(at))
            return
        seconds, fraction = struct.unpack(order + "II", record[:8])
        yield Frame(seconds * 10**9 + fraction * unit, link_type, data)
        at += 16 + size


def _pcapng(file: ForeignFile) -> Iterator[Chunk]:
    return _chunks(file, _pcapng_frames(file))


def _pcapng_frames(file: ForeignFile) -> Iterator[Frame]:
    parser = PacketParser(file.name, any_link=True)
    try:
        for block in blocks_of(BlockFile[None](file.blocks), file.name):
            if packet := parser.take(block):
                link_type = parser.link_types[packet.interface]
                yield Frame(packet.time_ns, link_type, packet.data)
    except Truncated as end:
        file.missing.append(_cut_off(end.offset))
    except CaptureError as error:
        raise UnreadableInput(file.name, f"is damaged: {error}") from None


def _cut_off(place: int) -> str:
    return f"ends in the middle of a packet; everything before byte {place} is complete"


def _first_link_type(head: bytes) -> int | None:
    """Return the link type of the first interface of a pcapng file, if the bytes show it."""
    parser = PacketParser("", any_link=True)
    try:
        for block in blocks_of(BytesIO(head), ""):
            parser.take(block)
            if parser.link_types:
                return parser.link_types[0]
    except (CaptureError, Truncated):
        pass
    return None


def _is_network(head: bytes) -> bool:
    """Return whether the first interface of a pcapng file is not a serial one."""
    link_type = _first_link_type(head)
    return link_type is not None and link_type not in USER_LINK_TYPES


PCAP = Reader("pcap", "a pcap file", lambda head: head[:4] in _ORDERS, _pcap)
PCAPNG = Reader("pcapng-tcp", "a capture of a network", _is_network, _pcapng)
READERS = (PCAP, PCAPNG)
