"""Join the TCP payloads of network captures: each byte once, in order, with every gap reported."""

from __future__ import annotations

import random
import shutil
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from capture.test_foreign import ANGLES, FILES, TALK, capture_of, directions, opened
from cobotwire.protocol.errors import UnreadableInput

ARM, CLIENT = bytes((10, 0, 0, 1)), bytes((10, 0, 0, 2))
SYN, ACK = 2, 16


def packet(
    number: int, data: bytes = b"", *, flags: int = ACK, acknowledged: int = 0, sent: bool = False
) -> bytes:
    """Return an IPv4 packet with a segment of the arm's port 9000, or to it if it is ``sent``."""
    ends = (CLIENT, 40000, ARM, 9000) if sent else (ARM, 9000, CLIENT, 40000)
    source, source_port, target, target_port = ends
    number &= 0xFFFFFFFF
    tcp = struct.pack(
        ">HHIIBBHHH", source_port, target_port, number, acknowledged, 0x50, flags, 0, 0, 0
    )
    head = struct.pack(">BBHHHBBH", 0x45, 0, 40 + len(data), 0, 0, 64, 6, 0)
    return head + source + target + tcp + data


def pcap(packets: list[bytes], link_type: int = 101, order: str = "<", nano: bool = False) -> bytes:
    magic = 0xA1B23C4D if nano else 0xA1B2C3D4
    head = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 65535, link_type)
    return head + b"".join(
        struct.pack(order + "IIII", 100, at, len(data), len(data)) + data
        for at, data in enumerate(packets)
    )


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("nano", [False, True])
def test_byte_order_and_unit_of_time_are_those_of_the_file(order: str, nano: bool) -> None:
    file = pcap([packet(0, ANGLES[:4]), packet(4, ANGLES[4:])], order=order, nano=nano)
    first, last = capture_of(opened(file))
    assert (first.time_ns, last.time_ns - first.time_ns) == (100 * 10**9, 1 if nano else 1000)


LINKS: dict[int, Callable[[bytes], bytes]] = {
    0: lambda data: b"\2\0\0\0" + data,
    108: lambda data: b"\0\0\0\2" + data,
    1: lambda data: bytes(12) + b"\x81\x00\x00\x05\x08\x00" + data,
    12: lambda data: data,
    101: lambda data: data,
    228: lambda data: data,
    113: lambda data: bytes(14) + b"\x08\x00" + data,
    276: lambda data: b"\x08\x00" + bytes(18) + data,
}


@pytest.mark.parametrize("link_type", LINKS)
def test_packet_is_found_after_the_header_of_its_link(link_type: int) -> None:
    file = pcap([LINKS[link_type](packet(0, ANGLES) + b"padding")], link_type)
    assert directions(capture_of(opened(file))) == {"received": ANGLES}


@pytest.mark.parametrize("order", ["-F pcapng", "-F pcap", "-F nsecpcap"])
def test_capture_that_editcap_converted_is_the_same(order: str, tmp_path: Path) -> None:
    if not shutil.which("editcap"):
        pytest.skip("editcap is not installed (Debian: apt install tshark)")
    path = tmp_path / "converted"
    command = ["editcap", *order.split(), str(FILES / "sll2-ipv6.pcap"), str(path)]
    subprocess.run(command, check=True)
    assert directions(capture_of(opened(path.read_bytes()))) == TALK


@given(
    st.binary(min_size=1, max_size=60),
    st.lists(st.tuples(st.integers(0, 59), st.integers(1, 20)), max_size=12),
    st.sampled_from([0, 0xFFFFFFF0]),
    st.randoms(use_true_random=False),
)
def test_segments_that_overlap_repeat_and_overtake_give_each_byte_once(
    data: bytes, repeated: list[tuple[int, int]], first: int, shuffle: random.Random
) -> None:
    cuts = [(at, 7) for at in range(0, len(data), 7)] + [each for each in repeated]
    shuffle.shuffle(cuts)
    packets = [packet(first + 1 + at, data[at : at + size]) for at, size in cuts if at < len(data)]
    capture = capture_of(opened(pcap([packet(first, flags=SYN), *packets])))
    assert directions(capture) == {"received": data}
    assert len(capture.interfaces) == 1


@pytest.mark.parametrize("acknowledged", [0, 40])
def test_lost_segment_divides_the_stream_and_is_reported(acknowledged: int) -> None:
    packets = [packet(0, ANGLES[:4]), packet(14, b"after")]
    # If the peer acknowledges the missing bytes, they are not sent again, so none are awaited.
    packets += [packet(0, acknowledged=acknowledged, sent=True), packet(19, b"!")]
    capture = capture_of(opened(pcap(packets)))
    found = [(each.interface, each.data) for each in capture]
    assert found == [(0, ANGLES[:4]), (1, b"after"), (1, b"!")]
    name = "10.0.0.1:9000 from 10.0.0.2:40000"
    assert capture.incomplete == (
        f"file lacks 10 bytes of {name}; what follows them is {name} part 2"
    )


def test_new_connection_between_the_same_ports_is_another_stream() -> None:
    packets = [packet(0, b"old"), packet(5000, flags=SYN), packet(5001, b"new")]
    capture = capture_of(opened(pcap(packets)))
    assert [(each.interface, each.data) for each in capture] == [(0, b"old"), (1, b"new")]


def test_payload_of_another_port_is_not_guessed() -> None:
    file = (FILES / "ethernet.pcap").read_bytes()
    with pytest.raises(UnreadableInput, match=r"port 9001; it holds ports 9000 \(6 packets\)"):
        list(capture_of(opened(file, ports=(9001,))))


def test_link_type_without_tcp_is_named() -> None:
    with pytest.raises(UnreadableInput, match=r"a capture of USB.* -e usb.capdata"):
        list(capture_of(opened(pcap([b"x"], 220))))


def test_serial_packets_of_a_classic_file_are_bytes_without_direction() -> None:
    assert directions(capture_of(opened(pcap([ANGLES], 147)))) == {"unknown": ANGLES}


def test_file_that_is_cut_off_is_reported() -> None:
    capture = capture_of(opened((FILES / "ethernet.pcap").read_bytes()[:-3]))
    assert list(capture)
    assert "ends in the middle of a packet; everything before byte" in capture.incomplete
