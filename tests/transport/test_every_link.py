"""What holds for a serial port and for TCP alike."""

from __future__ import annotations

import os
import select
import signal
import threading
import time
from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire.errors import LinkError
from cobotwire.transport import Link, Transport
from transport.ends import Line

KINDS = ["serial", "socket"]
AT_ONCE = 0.5


@pytest.fixture(params=KINDS)
def line(request: pytest.FixtureRequest) -> Iterator[Line]:
    with Line(request.param) as open_line:
        yield open_line


def read_all(link: Link, size: int, seconds: float = 5.0) -> bytes:
    """Read until ``size`` bytes have come."""
    deadline = time.monotonic() + seconds
    heard = b""
    while len(heard) < size and time.monotonic() < deadline:
        heard += link.read(0.1)
    return heard


def test_it_says_what_it_is(line: Line) -> None:
    assert isinstance(line.link, Transport)
    assert isinstance(line.link, Link)
    assert line.link.kind == line.end.kind
    assert line.link.url == line.end.url
    assert line.end.url in repr(line.link)


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=25)
@given(chunks=st.lists(st.binary(min_size=1, max_size=60), max_size=12))
def test_bytes_go_both_ways_however_they_are_cut(kind: str, chunks: list[bytes]) -> None:
    whole = b"".join(chunks)
    with Line(kind) as line:
        for chunk in chunks:
            line.end.say(chunk)
            line.link.write(chunk)
        assert read_all(line.link, len(whole)) == whole
        assert line.end.hear(len(whole)) == whole


def test_every_byte_value_goes_through_unchanged(line: Line) -> None:
    # XON, XOFF, NUL, Ctrl-C, CR, LF, 0xFF: all of these mean something to a terminal.
    every = bytes(range(256)) * 2
    line.link.write(every)
    assert line.end.hear(len(every)) == every
    line.end.say(every)
    assert read_all(line.link, len(every)) == every


def test_reading_waits_as_long_as_it_was_told_and_no_longer(line: Line) -> None:
    for seconds in (0.0, -1.0, 0.05):
        started = time.monotonic()
        assert line.link.read(seconds) == b""
        assert max(0.0, seconds) <= time.monotonic() - started < seconds + AT_ONCE + 1


def test_a_byte_that_comes_ends_the_wait(line: Line) -> None:
    saying = threading.Timer(0.05, line.end.say, [b"x"])
    saying.start()
    started = time.monotonic()
    assert line.link.read(10.0) == b"x"
    assert time.monotonic() - started < AT_ONCE
    saying.join()


def test_its_descriptor_can_be_waited_for(line: Line) -> None:
    descriptor = line.link.fileno()
    assert descriptor is not None
    assert select.select([descriptor], [], [], 0)[0] == []
    line.end.say(b"abc")
    assert select.select([descriptor], [], [], 5)[0] == [descriptor]
    assert line.link.read(0) == b"abc"


def test_unplugging_ends_the_wait_at_once(line: Line) -> None:
    pulling = threading.Timer(0.05, line.end.unplug)
    pulling.start()
    started = time.monotonic()
    with pytest.raises(LinkError, match="cannot be read"):
        line.link.read(10.0)
    assert time.monotonic() - started < AT_ONCE
    pulling.join()
    # And it stays that way.
    with pytest.raises(LinkError):
        line.link.read(0)


def test_what_came_before_the_end_is_read_first() -> None:
    with Line("socket") as line:
        line.end.say(b"last words")
        line.end.unplug()
        assert line.link.read(1.0) == b"last words"
        with pytest.raises(LinkError, match="the peer closed the connection"):
            line.link.read(1.0)


def test_closing_from_another_thread_ends_the_wait_at_once(line: Line) -> None:
    closing = threading.Timer(0.05, line.link.close)
    closing.start()
    started = time.monotonic()
    with pytest.raises(LinkError, match="closed meanwhile"):
        line.link.read(10.0)
    assert time.monotonic() - started < AT_ONCE
    closing.join()


def test_a_signal_may_close_the_link_that_is_waited_for(line: Line) -> None:
    old = signal.signal(signal.SIGALRM, lambda *_: line.link.close())
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        started = time.monotonic()
        with pytest.raises(LinkError, match="closed meanwhile"):
            line.link.read(10.0)
        assert time.monotonic() - started < AT_ONCE
    finally:
        signal.signal(signal.SIGALRM, old)


def test_a_closed_link_says_so(line: Line) -> None:
    line.link.close()
    line.link.close()
    for use in (
        lambda: line.link.read(0),
        lambda: line.link.write(b"x"),
        lambda: line.link.write_some(b"x"),
        line.link.fileno,
    ):
        with pytest.raises(LinkError, match="it is closed"):
            use()


def test_a_peer_that_takes_nothing_more_is_a_link_error_that_tells_how_much_it_took(
    line: Line,
) -> None:
    data = bytes(range(251)) * (400 if line.end.kind == "serial" else 60_000)
    if line.end.kind == "socket":
        # As a bridge's buffers fill up, so do the sockets' own; these hold megabytes.
        line.link._baudrate = 2**31 - 1  # type: ignore[attr-defined]
    started = time.monotonic()
    with pytest.raises(LinkError, match=r"of \d+ bytes \d+ were taken in") as caught:
        line.link.write(data)
    assert time.monotonic() - started < 4.0
    assert 0 <= caught.value.written < len(data)
    assert str(caught.value.written) in str(caught.value)
    assert line.end.hear(caught.value.written) == data[: caught.value.written]


def test_a_write_that_waits_ends_at_once_when_the_link_is_closed(line: Line) -> None:
    data = bytes(20_000_000)
    closing = threading.Timer(0.3, line.link.close)
    closing.start()
    started = time.monotonic()
    with pytest.raises(LinkError, match="closed meanwhile") as caught:
        line.link.write(data)
    assert time.monotonic() - started < 0.3 + AT_ONCE
    assert caught.value.written > 0
    closing.join()


def test_ctrl_c_in_a_write_finishes_the_frame_first(line: Line) -> None:
    data = bytes(range(251)) * (400 if line.end.kind == "serial" else 40_000)
    line.link._baudrate = 100_000  # type: ignore[attr-defined]  # so that there is time enough
    heard: list[bytes] = []

    def interrupt_and_hear() -> None:
        time.sleep(0.1)
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)
        heard.append(line.end.hear(len(data)))

    hearing = threading.Thread(target=interrupt_and_hear)
    hearing.start()
    with pytest.raises(KeyboardInterrupt):
        line.link.write(data)
    hearing.join()
    assert heard == [data]


def test_an_offer_takes_what_fits_and_never_waits(line: Line) -> None:
    block = bytes(1_000_000)
    started = time.monotonic()
    taken = [line.link.write_some(block) for _ in range(200)]
    assert time.monotonic() - started < 3.0
    assert taken[0] > 0
    assert taken[-1] < len(block)


def test_one_thread_reads_while_another_writes(line: Line) -> None:
    heard: list[bytes] = []
    reading = threading.Thread(target=lambda: heard.append(line.link.read(5.0)))
    reading.start()
    time.sleep(0.05)
    line.link.write(b"question")
    assert line.end.hear(8) == b"question"
    line.end.say(b"answer")
    reading.join()
    assert heard == [b"answer"]
