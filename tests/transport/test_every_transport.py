"""Check the behaviour that a serial port and TCP share."""

from __future__ import annotations

import os
import select
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.protocol.errors import LinkError
from cobotwire.transport import OpenedTransport, Transport
from cobotwire.transport.descriptor import DescriptorTransport
from transport.ends import Line

KINDS = ["serial", "socket"]
# In the native module, and in Python without it.
LINES = [("serial", "native"), ("socket", "native"), ("serial", "reference")]
AT_ONCE = 0.5


@pytest.fixture(params=LINES)
def line(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[Line]:
    kind, codec = request.param
    monkeypatch.setenv(codecs.VARIABLE, codec)
    with Line(kind) as open_line:
        assert isinstance(open_line.transport, DescriptorTransport)
        assert (open_line.transport._native is not None) == (codec == "native")
        yield open_line


def read_all(transport: OpenedTransport, size: int, seconds: float = 5.0) -> bytes:
    """Read until ``size`` bytes have arrived."""
    deadline = time.monotonic() + seconds
    received = b""
    while len(received) < size and time.monotonic() < deadline:
        received += transport.read(0.1)
    return received


def test_transport_names_its_url_and_kind(line: Line) -> None:
    assert isinstance(line.transport, Transport)
    assert isinstance(line.transport, OpenedTransport)
    assert line.transport.kind == line.end.kind
    assert line.transport.url == line.end.url
    assert line.end.url in repr(line.transport)


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=25)
@given(chunks=st.lists(st.binary(min_size=1, max_size=60), max_size=12))
def test_bytes_arrive_in_both_directions_in_any_chunks(kind: str, chunks: list[bytes]) -> None:
    whole = b"".join(chunks)
    with Line(kind) as line:
        for chunk in chunks:
            line.end.send(chunk)
            line.transport.write(chunk)
        assert read_all(line.transport, len(whole)) == whole
        assert line.end.receive(len(whole)) == whole


def test_every_byte_value_arrives_unchanged(line: Line) -> None:
    # XON, XOFF, NUL, Ctrl-C, CR, LF, 0xFF: all of these mean something to a terminal.
    every = bytes(range(256)) * 2
    line.transport.write(every)
    assert line.end.receive(len(every)) == every
    line.end.send(every)
    assert read_all(line.transport, len(every)) == every


def test_read_waits_for_its_timeout(line: Line) -> None:
    for seconds in (0.0, -1.0, 0.05):
        started = time.monotonic()
        assert line.transport.read(seconds) == b""
        assert max(0.0, seconds) <= time.monotonic() - started < seconds + AT_ONCE + 1


def test_received_byte_ends_the_wait(line: Line) -> None:
    sending = threading.Timer(0.05, line.end.send, [b"x"])
    sending.start()
    started = time.monotonic()
    assert line.transport.read(10.0) == b"x"
    assert time.monotonic() - started < AT_ONCE
    sending.join()


def test_descriptor_can_be_waited_for(line: Line) -> None:
    descriptor = line.transport.fileno()
    assert descriptor is not None
    assert select.select([descriptor], [], [], 0)[0] == []
    line.end.send(b"abc")
    assert select.select([descriptor], [], [], 5)[0] == [descriptor]
    assert line.transport.read(0) == b"abc"


def test_unplugging_ends_the_wait_at_once(line: Line) -> None:
    unplugging = threading.Timer(0.05, line.end.unplug)
    unplugging.start()
    started = time.monotonic()
    with pytest.raises(LinkError, match="cannot be read"):
        line.transport.read(10.0)
    assert time.monotonic() - started < AT_ONCE
    unplugging.join()
    # Every later read fails, too.
    with pytest.raises(LinkError):
        line.transport.read(0)


def test_data_sent_before_the_connection_ends_is_read_first() -> None:
    with Line("socket") as line:
        line.end.send(b"last words")
        line.end.unplug()
        assert line.transport.read(1.0) == b"last words"
        with pytest.raises(LinkError, match="the peer closed the connection"):
            line.transport.read(1.0)


def test_closing_from_another_thread_ends_the_wait_at_once(line: Line) -> None:
    closing = threading.Timer(0.05, line.transport.close)
    closing.start()
    started = time.monotonic()
    with pytest.raises(LinkError, match="closed meanwhile"):
        line.transport.read(10.0)
    assert time.monotonic() - started < AT_ONCE
    closing.join()


@contextmanager
def alarm(seconds: float, handler: Callable[[], object]) -> Iterator[None]:
    """Have a signal handler called after some seconds."""
    before = signal.signal(signal.SIGALRM, lambda *_: handler())
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.signal(signal.SIGALRM, before)


def test_signal_handler_ends_a_read_with_its_exception(line: Line) -> None:
    def interrupt() -> None:
        raise KeyboardInterrupt

    started = time.monotonic()
    with alarm(0.05, interrupt), pytest.raises(KeyboardInterrupt):
        line.transport.read(30.0)
    assert time.monotonic() - started < 10
    line.end.send(b"after")
    assert line.transport.read(5.0) == b"after"


def test_signal_handler_that_returns_does_not_end_a_read(line: Line) -> None:
    calls: list[int] = []
    sending = threading.Timer(0.2, line.end.send, [b"x"])
    sending.start()
    with alarm(0.02, lambda: calls.append(1)):
        assert line.transport.read(30.0) == b"x"
    sending.join()
    assert calls


def test_signal_handler_may_close_the_transport_that_is_read(line: Line) -> None:
    started = time.monotonic()
    with alarm(0.05, line.transport.close), pytest.raises(LinkError, match="closed meanwhile"):
        line.transport.read(10.0)
    assert time.monotonic() - started < AT_ONCE


def test_use_of_a_closed_transport_is_a_link_error(line: Line) -> None:
    line.transport.close()
    line.transport.close()
    for use in (
        lambda: line.transport.read(0),
        lambda: line.transport.write(b"x"),
        lambda: line.transport.write_some(b"x"),
        line.transport.fileno,
    ):
        with pytest.raises(LinkError, match="it is closed"):
            use()


def test_stuck_write_is_a_link_error_with_the_number_of_bytes_written(
    line: Line,
) -> None:
    data = bytes(range(251)) * (400 if line.end.kind == "serial" else 60_000)
    if line.end.kind == "socket":
        # Only megabytes fill the socket buffers. A high baud rate keeps the time limit short.
        line.transport._baudrate = 2**31 - 1  # type: ignore[attr-defined]
    started = time.monotonic()
    with pytest.raises(LinkError, match=r"only \d+ of \d+ bytes were taken in") as caught:
        line.transport.write(data)
    assert time.monotonic() - started < 4.0
    written = caught.value.written
    assert written is not None
    assert 0 <= written < len(data)
    assert str(written) in str(caught.value)
    assert line.end.receive(written) == data[:written]


def test_closing_ends_a_waiting_write_at_once(line: Line) -> None:
    data = bytes(20_000_000)
    closing = threading.Timer(0.3, line.transport.close)
    closing.start()
    started = time.monotonic()
    with pytest.raises(LinkError, match="closed meanwhile") as caught:
        line.transport.write(data)
    assert time.monotonic() - started < 0.3 + AT_ONCE
    assert caught.value.written
    closing.join()


def test_ctrl_c_during_a_write_is_raised_after_the_whole_frame(line: Line) -> None:
    data = bytes(range(251)) * (400 if line.end.kind == "serial" else 40_000)
    line.transport._baudrate = 100_000  # type: ignore[attr-defined]  # allows a long write
    received: list[bytes] = []

    def interrupt_and_receive() -> None:
        time.sleep(0.1)
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)
        received.append(line.end.receive(len(data)))

    interrupting = threading.Thread(target=interrupt_and_receive)
    interrupting.start()
    with pytest.raises(KeyboardInterrupt):
        line.transport.write(data)
    interrupting.join()
    assert received == [data]


def test_write_some_writes_what_fits_and_never_waits(line: Line) -> None:
    block = bytes(1_000_000)
    started = time.monotonic()
    taken = [line.transport.write_some(block) for _ in range(200)]
    assert time.monotonic() - started < 3.0
    assert taken[0] > 0
    assert taken[-1] < len(block)


def test_one_thread_reads_while_another_writes(line: Line) -> None:
    received: list[bytes] = []
    reading = threading.Thread(target=lambda: received.append(line.transport.read(5.0)))
    reading.start()
    time.sleep(0.05)
    line.transport.write(b"request!")
    assert line.end.receive(8) == b"request!"
    line.end.send(b"reply")
    reading.join()
    assert received == [b"reply"]
