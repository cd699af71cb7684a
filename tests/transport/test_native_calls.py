"""Reads that wait end by a signal or by closing, in the native module as in Python."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator

import pytest

from cobotwire import codec as codecs
from cobotwire.transport.descriptor import DescriptorTransport
from transport.ends import Line

pytestmark = pytest.mark.skipif(not codecs.native_available(), reason="there is no native module")


@pytest.fixture(params=[("native", "serial"), ("native", "socket"), ("reference", "serial")])
def line(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[Line]:
    monkeypatch.setenv(codecs.VARIABLE, request.param[0])
    with Line(request.param[1]) as open_line:
        assert isinstance(open_line.transport, DescriptorTransport)
        assert (open_line.transport._native is not None) == (request.param[0] == "native")
        yield open_line


def test_signal_handler_ends_a_read_with_its_exception(line: Line) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    started = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            line.transport.read(30.0)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - started < 10
    line.end.send(b"after")
    assert line.transport.read(5.0) == b"after"


def test_handler_that_returns_does_not_end_a_read(line: Line) -> None:
    calls: list[int] = []
    before = signal.signal(signal.SIGALRM, lambda *_: calls.append(1))
    signal.setitimer(signal.ITIMER_REAL, 0.02)
    sending = threading.Timer(0.2, line.end.send, [b"x"])
    sending.start()
    try:
        assert line.transport.read(30.0) == b"x"
    finally:
        signal.signal(signal.SIGALRM, before)
        sending.join()
    assert calls
