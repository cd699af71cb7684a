"""Reopen transports that were closed, lost, or are still present."""

from __future__ import annotations

import pytest

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import open_transport
from transport.ends import FAST, Line, TcpEnd


def test_transport_reconnects_to_a_server_that_hung_up() -> None:
    with Line("socket") as line:
        assert isinstance(line.end, TcpEnd)
        for round_ in range(3):
            line.end.hang_up()
            with pytest.raises(LinkError):
                line.transport.read(1.0)
            line.transport.reopen()
            line.end.accept()
            line.end.send(b"%d" % round_)
            assert line.transport.read(1.0) == b"%d" % round_


def test_present_port_is_reopened() -> None:
    with Line("serial") as line:
        line.transport.write(b"one")
        assert line.end.receive(3) == b"one"
        line.transport.reopen()
        line.transport.write(b"two")
        assert line.end.receive(3) == b"two"


def test_closed_transport_can_be_reopened() -> None:
    with Line("serial") as line:
        line.transport.close()
        line.transport.reopen()
        line.end.send(b"x")
        assert line.transport.read(1.0) == b"x"


@pytest.mark.parametrize("kind", ["serial", "socket"])
def test_reopening_a_vanished_port_fails_and_can_be_repeated(kind: str) -> None:
    with Line(kind) as line:
        line.end.unplug()
        for _ in range(2):
            with pytest.raises(LinkError, match="cannot be opened"):
                line.transport.reopen()
        with pytest.raises(LinkError, match="it is closed"):
            line.transport.read(0)


def test_other_pyserial_urls_are_reopened() -> None:
    transport = open_transport("loop://", FAST)
    assert transport.kind == "loop"
    assert transport.fileno() is None
    transport.write(b"before")
    transport.reopen()
    transport.write(b"after")
    assert transport.read(0.5).startswith(b"a")
    transport.close()
    with pytest.raises(LinkError, match="it is closed"):
        transport.write_some(b"x")
