"""Calls end in time even if the peer never stops sending."""

from __future__ import annotations

import os
import select
import socket
import threading
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

import pytest

from cobotwire import MyCobot, ReplyTimeout
from cobotwire.codec import CodecName
from recording_transport import RecordingTransport

TIMEOUT = 0.4
BABBLE = b"cmd_len error\r\n" * 256
FRAMES = bytes.fromhex("FE FE 03 12 01 FA") * 512


@contextmanager
def flood(write: Callable[[bytes], object], babble: bytes) -> Iterator[None]:
    """Write without end; ``write`` must not block forever."""
    stop = threading.Event()

    def play() -> None:
        while not stop.is_set():
            write(babble)

    thread = threading.Thread(target=play)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


@contextmanager
def over_tcp(babble: bytes) -> Iterator[str]:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        client: list[socket.socket] = []

        def write(data: bytes) -> None:
            if not client:
                client.append(listening.accept()[0])
                client[0].settimeout(0.05)
            try:
                client[0].send(data)
            except OSError:
                time.sleep(0.01)

        with flood(write, babble):
            yield f"socket://127.0.0.1:{listening.getsockname()[1]}"
        for connection in client:
            connection.close()


@contextmanager
def over_pty(babble: bytes) -> Iterator[str]:
    master, slave = os.openpty()
    tty.setraw(slave)
    os.set_blocking(master, False)

    def write(data: bytes) -> None:
        if select.select([], [master], [], 0.05)[1]:
            try:
                os.write(master, data)
            except BlockingIOError:
                time.sleep(0.001)

    with flood(write, babble):
        yield os.ttyname(slave)
    os.close(master)
    os.close(slave)


# Each pair of codec, line and bytes runs once.
@pytest.mark.parametrize(
    ("codec", "line", "babble"),
    [
        ("native", over_tcp, BABBLE),
        ("native", over_pty, FRAMES),
        ("reference", over_tcp, FRAMES),
        ("reference", over_pty, BABBLE),
    ],
    ids=["native-noise", "native-frames", "reference-frames", "reference-noise"],
)
def test_endless_traffic_does_not_delay_a_timeout(
    codec: CodecName, line: Callable[[bytes], AbstractContextManager[str]], babble: bytes
) -> None:
    with line(babble) as url:
        with MyCobot(url, timeout=TIMEOUT, codec=codec) as arm:
            for call in (arm.get_angles, arm.get_ssid_pwd):
                started = time.monotonic()
                with pytest.raises(ReplyTimeout) as caught:
                    call()
                silence = 0.2 if call == arm.get_ssid_pwd else 0.0
                assert time.monotonic() - started < 2 * TIMEOUT + silence
                assert len(caught.value.received) <= 20
                assert sum(map(len, caught.value.received)) < 3000
            started = time.monotonic()
            arm.stop()
            assert time.monotonic() - started < TIMEOUT, "one-way requests are sent all the same"


class Torrent(RecordingTransport):
    """A transport that always has more bytes to read."""

    def read(self, timeout: float) -> bytes:
        time.sleep(0.001)
        return b"x" * 100


def test_held_request_is_not_sent_while_bytes_keep_arriving() -> None:
    transport = Torrent()
    arm = MyCobot(transport, timeout=0.1)
    for message in ("received meanwhile: noise", "not sent"):
        started = time.monotonic()
        with pytest.raises(ReplyTimeout, match=message):
            arm.get_encoder(1)
        assert time.monotonic() - started < 1.5
    arm.stop()
    assert transport.written == bytes.fromhex("FEFE033B01FA FEFE0229FA")
