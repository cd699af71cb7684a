"""Tap a transport: a function receives a copy of its traffic."""

from __future__ import annotations

import time

import pytest

from cobotwire import MyCobot
from cobotwire.protocol.errors import LinkError
from cobotwire.simulator import PtyServer
from cobotwire.transport import OpenedTransport, TappedTransport, open_transport
from transport.ends import FAST, Line

Seen = list[tuple[str, bytes, float]]


def tapped(transport: OpenedTransport) -> tuple[TappedTransport, Seen]:
    seen: Seen = []
    return TappedTransport(transport, lambda *what: seen.append(what)), seen


def test_client_accepts_a_tapped_transport(server: PtyServer) -> None:
    transport, seen = tapped(open_transport(server.url, FAST))
    assert isinstance(transport, OpenedTransport)
    with MyCobot(transport) as arm:
        arm.power_on()
        assert arm.is_power_on() is True
    sent = b"".join(data for way, data, _ in seen if way == "sent")
    assert sent.startswith(bytes.fromhex("FE FE 02 10 FA"))
    assert any(way == "received" for way, _, _ in seen)


@pytest.mark.parametrize("kind", ["serial", "socket"])
def test_tap_gets_each_chunk_when_it_passes(kind: str) -> None:
    with Line(kind) as line:
        transport, seen = tapped(line.transport)
        line.end.send(b"half")
        assert transport.read(1.0) == b"half"
        assert transport.read(0.02) == b""
        line.end.send(b" and half")
        assert transport.read(1.0) == b" and half"
        transport.write(b"whole")
        taken = transport.write_some(b"some")
        assert taken == 4
        assert [what[:2] for what in seen] == [
            ("received", b"half"),
            ("received", b" and half"),
            ("sent", b"whole"),
            ("sent", b"some"),
        ]
        times = [what[2] for what in seen]
        assert times == sorted(times)
        assert times[-1] <= time.monotonic()
        assert transport.fileno() == line.transport.fileno()
        assert transport.low_latency == line.transport.low_latency


def test_tap_gets_the_written_bytes_of_a_failed_write() -> None:
    with Line("serial") as line:
        transport, seen = tapped(line.transport)
        data = bytes(range(250)) * 100
        with pytest.raises(LinkError) as caught:
            transport.write(data)
        assert seen[0][:2] == ("sent", data[: caught.value.written])
        transport.reopen()
        transport.close()
        with pytest.raises(LinkError, match="it is closed"):
            transport.read(0)
