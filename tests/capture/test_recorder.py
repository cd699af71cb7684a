"""Record traffic: every byte of both directions, with its time."""

from __future__ import annotations

import errno
import io
import logging
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given

from capture.lines import FRAMES, Chunk, chunks, line_bytes, reader
from cobotwire import MyCobot
from cobotwire import codec as codecs
from cobotwire.capture import CaptureWriter, Packet, Recorder, Recording, read
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import CaptureError, UsageError
from cobotwire.simulator import PtyServer
from cobotwire.transport import TappedTransport, open_transport

QUERY, ANGLES = FRAMES[0], FRAMES[1]


def recorded(codec: Codec | None, given_chunks: list[Chunk]) -> list[Packet]:
    file = io.BytesIO()
    writer = CaptureWriter(file)
    recorder = Recorder(writer, codec)
    for chunk in given_chunks:
        recorder(chunk)
    recorder.close()
    writer.finish()
    return list(reader(file.getvalue()))


def pieces_of(packets: list[Packet], direction: str) -> list[tuple[int, int]]:
    """Return value and time of each byte of a direction, in order."""
    found: list[tuple[int, int]] = []
    for packet in packets:
        if packet.direction == direction:
            times = [t for size, t in packet.pieces for _ in range(size)]
            found += zip(packet.data, times or [packet.time_ns] * len(packet.data))
    return found


@given(given_chunks=chunks())
def test_packets_of_a_direction_hold_every_byte_with_its_time(
    given_chunks: list[Chunk],
) -> None:
    for codec in (None, codecs.load(TABLE)):
        packets = recorded(codec, given_chunks)
        start = time.time_ns() - time.monotonic_ns()
        for direction in ("sent", "received"):
            own = [chunk for chunk in given_chunks if chunk.direction == direction]
            expected = [(byte, round(chunk.time * 1e9)) for chunk in own for byte in chunk.data]
            found = pieces_of(packets, direction)
            assert [byte for byte, _ in found] == [byte for byte, _ in expected]
            # The recorder adds the same offset to all times.
            added = {got - given for (_, got), (_, given) in zip(found, expected)}
            assert len(added) <= 1
            assert all(abs(each - start) < 10**10 for each in added)
        assert all(packet.data for packet in packets)


def test_frames_and_noise_become_separate_packets(codec: Codec) -> None:
    panic = b"Guru Meditation"
    packets = recorded(
        codec,
        [Chunk(1.0, "sent", QUERY + QUERY), Chunk(1.01, "received", FRAMES[2] + panic + ANGLES)],
    )
    assert [(p.direction, p.kind, p.data) for p in packets] == [
        ("sent", "frame", QUERY),
        ("sent", "frame", QUERY),
        ("received", "frame", FRAMES[2]),
        ("received", "noise", panic),
        ("received", "frame", ANGLES),
    ]
    assert packets[3].reason == "no-header"


def test_traffic_of_a_client_is_recorded(server: PtyServer, tmp_path: Path) -> None:
    traffic: list[Chunk] = []
    path = tmp_path / "arm.pcapng"
    codec = codecs.load(TABLE)
    with Recording(path, codec, url=server.url, baudrate=115200) as recording:

        def trace(item: Any) -> None:
            traffic.append(Chunk(item.time, item.direction, item.data))
            recording(item)

        with MyCobot(server.url, trace=trace) as arm:
            arm.power_on()
            arm.get_angles()
    with read(path) as capture:
        packets = list(capture)
    assert capture.finished
    assert capture.interfaces == [(server.url, "mycobot", 115200)]
    for direction in ("sent", "received"):
        data = b"".join(chunk.data for chunk in traffic if chunk.direction == direction)
        assert line_bytes(packets, direction) == data
    assert {packet.kind for packet in packets} == {"frame"}
    assert abs(packets[0].time_ns - time.time_ns()) < 60e9


def test_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "there.pcapng"
    path.write_bytes(b"mine")
    with pytest.raises(UsageError, match="the file exists already"):
        Recording(path, None)
    assert path.read_bytes() == b"mine"
    with pytest.raises(UsageError, match="no such file"):
        Recording(tmp_path / "no" / "folder", None)


KILLED = """
import os, signal, sys
from capture.lines import Chunk, FRAMES
from cobotwire import codec as codecs
from cobotwire.capture import Recording
from cobotwire.editions.mycobot import TABLE
recording = Recording(sys.argv[1], codecs.load(TABLE))
for i in range(100):
    recording(Chunk(i / 100, "received", FRAMES[1]))
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_killed_process_leaves_every_complete_frame(tmp_path: Path) -> None:
    path = tmp_path / "killed.pcapng"
    tests = Path(__file__).parents[1]
    result = subprocess.run([sys.executable, "-c", KILLED, str(path)], cwd=tests, check=False)
    assert result.returncode == -signal.SIGKILL
    capture = read(path)
    assert len(list(capture)) == 100
    assert not capture.finished


@pytest.mark.skipif(
    not os.path.exists("/dev/full"), reason="only Linux has a device that is always full"
)
def test_full_disk_stops_the_recording_but_not_the_call(
    caplog: pytest.LogCaptureFixture, server: PtyServer
) -> None:
    with open("/dev/full", "wb", buffering=0) as full:
        good = io.BytesIO()
        writer = CaptureWriter(good)
        recorder = Recorder(writer, codecs.load(TABLE), name="full.pcapng")
        writer._file = full
        transport = TappedTransport(open_transport(server.url, 115200), recorder.record)
        with caplog.at_level(logging.ERROR), MyCobot(transport) as arm:
            arm.power_on()
            arm.get_angles()
        assert caplog.text.count("recording to full.pcapng stopped") == 1
        with pytest.raises(CaptureError, match="the recording is incomplete") as caught:
            recorder.close()
        assert caught.value.offset == len(good.getvalue())
        assert isinstance(caught.value.__cause__, OSError)
        assert caught.value.__cause__.errno == errno.ENOSPC
