"""Use clients on transports that cannot be opened, that break, or that echo."""

from __future__ import annotations

import os
import select
import socket
import termios
import threading
import time
import tty
from contextlib import suppress

import pytest

from cobotwire import LinkError, MyCobot, ReplyTimeout, UsageError
from cobotwire import codec as codecs
from cobotwire.client import Traffic
from recording_transport import RecordingTransport
from scripted_peer import ScriptedPeer


def test_native_codec_without_its_binary_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(codecs, "native_available", lambda: False)
    with pytest.raises(UsageError, match="the native codec is not installed; use 'reference'"):
        MyCobot("loop://", codec="native")


def _query_forever(arm: MyCobot) -> None:
    while True:
        with suppress(ReplyTimeout):
            arm.get_angles()


@pytest.mark.parametrize("kind", ["socket", "pty"])
def test_transport_that_another_thread_closes_is_a_link_error(kind: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening, ScriptedPeer() as peer:
        url = f"socket://127.0.0.1:{listening.getsockname()[1]}" if kind == "socket" else peer.url
        for _ in range(3):
            arm = MyCobot(url, timeout=0.3)
            closing = threading.Timer(0.05, arm.close)
            closing.start()
            with pytest.raises(LinkError, match=r"closed|disconnected"):
                _query_forever(arm)
            closing.join()


def test_terminal_error_is_a_link_error(monkeypatch: pytest.MonkeyPatch) -> None:
    # pyserial itself writes to the port of a spy:// URL.
    with ScriptedPeer() as peer, MyCobot(f"spy://{peer.url}") as arm:

        def fail(*arguments: object) -> int:
            raise termios.error(5, "Input/output error")

        # No real port can be made to fail in this way.
        monkeypatch.setattr(arm._connection._transport._port, "write", fail)  # type: ignore[attr-defined]
        with pytest.raises(LinkError, match=r"cannot be written: .*Input/output error"):
            arm.power_on()


def test_wrong_argument_is_rejected_even_on_a_closed_port() -> None:
    with ScriptedPeer() as peer:
        arm = MyCobot(peer.url)
        arm.close()
        with pytest.raises(UsageError, match="joint is 9"):
            arm.get_encoder(9)


class Full(RecordingTransport):
    """A transport that accepts no more bytes."""

    def write(self, data: bytes) -> None:
        raise LinkError(self.url, "is full")


def test_failed_write_is_not_reported_to_the_traffic_listener() -> None:
    traffic: list[Traffic] = []
    with pytest.raises(LinkError, match="full"):
        MyCobot(Full(), trace=traffic.append).power_on()
    assert traffic == []


def test_spy_url_opens_a_port() -> None:
    master, slave = os.openpty()
    tty.setraw(slave)
    try:
        with MyCobot(f"spy://{os.ttyname(slave)}", timeout=0.3) as arm:
            os.write(master, bytes.fromhex("FE FE 03 12 00 FA"))
            # A pty delivers bytes after a moment; wait until they precede the request.
            assert select.select([slave], [], [], 5)[0]
            started = time.monotonic()
            with pytest.raises(ReplyTimeout):
                arm.is_power_on()
            assert time.monotonic() - started < 1.0
    finally:
        os.close(master)
        os.close(slave)
