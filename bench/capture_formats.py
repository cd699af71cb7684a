"""Compare our captures with MCAP and python-pcapng, for docs/captures.md.

Install both first: pip install mcap python-pcapng
"""

from __future__ import annotations

import importlib
import io
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

FRAME = bytes.fromhex("FE FE 0E 20 00 01 FF FF 00 03 00 04 00 05 00 06 FA")
FRAMES = 20_000
STEP_NS = 10_000_000


def ours() -> tuple[float, bytes, bytes]:
    """Return microseconds per frame, the file of a killed writer, and that of a closed one."""
    from cobotwire.capture import CaptureWriter, Interface, Packet

    file = io.BytesIO()
    writer = CaptureWriter(file)
    writer.interface(Interface("/dev/ttyACM0", "mycobot", 115200))
    cost = timed(lambda n: writer.packet(Packet(n * STEP_NS, "received", FRAME)))
    killed = file.getvalue()
    writer.finish()
    return cost, killed, file.getvalue()


def mcap(**options: Any) -> tuple[float, bytes, bytes]:
    """Return the same for MCAP."""
    file = io.BytesIO()
    writer = importlib.import_module("mcap.writer").Writer(file, **options)
    writer.start("", "bench")
    schema = writer.register_schema("", "", b"")
    channel = writer.register_channel("received", "application/octet-stream", schema)
    cost = timed(lambda n: writer.add_message(channel, n * STEP_NS, FRAME, n * STEP_NS))
    killed = file.getvalue()
    writer.finish()
    return cost, killed, file.getvalue()


def pcapng() -> tuple[float, bytes, bytes]:
    """Return the same for python-pcapng."""
    package = importlib.import_module("pcapng")
    blocks = importlib.import_module("pcapng.blocks")
    file = io.BytesIO()
    section = blocks.SectionHeader(options={"shb_userappl": "bench"})
    section.new_member(blocks.InterfaceDescription, link_type=159, options={"if_name": "line"})
    writer = package.FileWriter(file, section)

    def write(n: int) -> None:
        packet = section.new_member(
            blocks.EnhancedPacket, packet_data=FRAME, options={"epb_flags": 1}
        )
        packet.timestamp = n * STEP_NS / 1e9
        writer.write_block(packet)

    cost = timed(write)
    return cost, file.getvalue(), file.getvalue()


def timed(write: Callable[[int], object]) -> float:
    """Return the microseconds that one frame takes to write."""
    started = time.perf_counter()
    for n in range(FRAMES):
        write(n)
    return (time.perf_counter() - started) / FRAMES * 1e6


def read_ours(data: bytes) -> int:
    """Count the packets that our reader finds."""
    from cobotwire.capture import CaptureReader

    return sum(1 for _ in CaptureReader(io.BytesIO(data)))


def read_mcap(data: bytes) -> int:
    """Count the packets that MCAP's stream reader finds; it needs no index at the end."""
    reader = importlib.import_module("mcap.reader").NonSeekingReader(io.BytesIO(data))
    return sum(1 for _ in reader.iter_messages())


def read_pcapng(data: bytes) -> int:
    """Count the packets that python-pcapng finds: all blocks except section and interface."""
    scanner = importlib.import_module("pcapng.scanner").FileScanner(io.BytesIO(data))
    return sum(1 for _ in scanner) - 2


def outcome(read: Callable[[bytes], int], data: bytes) -> str:
    """Return the number of packets that ``read`` finds, or the name of its error."""
    try:
        return f"{read(data)} packets"
    except Exception as error:
        return type(error).__name__


def damaged(data: bytes) -> bytes:
    """Return the capture with the length before its tenth frame set to 0, at pcapng's offset."""
    place = 0
    for _ in range(10):
        place = data.find(FRAME, place + 1)
    return data if place < 0 else data[: place - 24] + bytes(4) + data[place - 20 :]


def import_seconds(module: str) -> float:
    """Return the seconds that an import adds to the start of a new interpreter."""

    def best(script: str) -> float:
        times = []
        for _ in range(5):
            started = time.perf_counter()
            subprocess.run([sys.executable, "-c", script], check=True)
            times.append(time.perf_counter() - started)
        return min(times)

    return best(f"import {module}") - best("pass")


def main() -> None:
    """Print a table."""
    chosen: list[tuple[str, str, tuple[float, bytes, bytes], Callable[[bytes], int]]] = [
        ("cobotwire.capture", "cobotwire.capture", ours(), read_ours),
        ("mcap", "mcap.writer", mcap(), read_mcap),
        ("mcap, no chunks", "mcap.writer", mcap(use_chunking=False), read_mcap),
        ("python-pcapng", "pcapng.blocks", pcapng(), read_pcapng),
    ]
    print(f"{'':20}{'import ms':>10}{'us a frame':>12}{'bytes a frame':>15}  killed: read back")
    for name, module, (cost, killed, whole), read in chosen:
        load = import_seconds(module) * 1e3
        size = len(whole) / FRAMES
        left = f"{len(killed)} bytes, {outcome(read, killed)}"
        print(f"{name:20}{load:10.0f}{cost:12.1f}{size:15.1f}  {left}")
        print(f"{'':20}a length of 0 in the middle: {outcome(read, damaged(whole))}")
        started = time.perf_counter()
        read(whole)
        print(f"{'':20}reading: {(time.perf_counter() - started) / FRAMES * 1e6:.1f} us a frame")


if __name__ == "__main__":
    main()
