"""Waiting, reading and writing in the native module has the results of waiting in Python."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from cobotwire import RetryPolicy
from cobotwire import codec as codecs
from cobotwire.codec.interface import Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import LinkError
from cobotwire.session import EncodedRequest, PendingRequest
from cobotwire.transport.descriptor import DescriptorTransport
from cobotwire.transport.waiting import line_lock
from transport.ends import Line
from transport.swapping import REQUEST, Swapping

pytestmark = pytest.mark.skipif(not codecs.native_available(), reason="there is no native module")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")


@pytest.fixture(params=[("native", "serial"), ("native", "socket"), ("reference", "serial")])
def line(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[Line]:
    monkeypatch.setenv(codecs.VARIABLE, request.param[0])
    with Line(request.param[1]) as open_line:
        assert isinstance(open_line.transport, DescriptorTransport)
        assert open_line.transport.lends == (request.param[0] == "native")
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


def test_close_ends_a_read_in_another_thread(line: Line) -> None:
    closing = threading.Timer(0.05, line.transport.close)
    closing.start()
    with pytest.raises(LinkError, match="it was closed meanwhile"):
        line.transport.read(30.0)
    closing.join()


@pytest.fixture
def swapping() -> Iterator[Swapping]:
    made = Swapping()
    yield made
    made.close()


def test_swap_returns_the_only_frame_and_its_fields(swapping: Swapping) -> None:
    answering = swapping.answer_with(ANGLES)
    started = time.monotonic()
    fields, requested_at, replied_at = swapping.swap()
    answering.join()
    assert started <= requested_at < replied_at <= time.monotonic()
    assert swapping.peer.recv(99) == REQUEST
    assert fields == swapping.codec.decode("reply", ANGLES, of="get_angles").fields


@pytest.mark.parametrize(
    "received", [ANGLES + b"x", b"x" + ANGLES, ANGLES * 2, ANGLES[:9], REQUEST], ids=bytes.hex
)
def test_swap_returns_events_if_more_or_less_than_the_reply_comes(
    swapping: Swapping, received: bytes
) -> None:
    plain = codecs.load(TABLE, "native").framer("reply")
    answering = swapping.answer_with(received)
    events = swapping.swap()
    answering.join()
    assert events == plain.feed(received)
    assert swapping.framer.pending == plain.pending
    assert swapping.framer.fed == len(received)


def test_swap_sends_nothing_on_a_line_that_is_not_free(swapping: Swapping) -> None:
    with swapping.writing:
        assert swapping.swap() is None
    swapping.peer.send(b"earlier")
    assert swapping.swap() is None
    assert swapping.ours.recv(99) == b"earlier"
    swapping.peer.setblocking(False)
    with pytest.raises(BlockingIOError):
        swapping.peer.recv(99)
    assert swapping.framer.fed == 0


def take_in_another_thread(lock: Any) -> None:
    taking = threading.Thread(target=lock.acquire)
    taking.start()
    taking.join()


PENDING = PendingRequest(
    EncodedRequest(TABLE.command("get_angles"), REQUEST, b"", {}), 1.0, RetryPolicy(), 0.0
)
BUSY: dict[str, Callable[[Swapping], object]] = {
    "a thread is at a step": lambda one: one.steps.state.acquire(),
    "a thread reads": lambda one: take_in_another_thread(one.steps.reading),
    "a thread has the descriptor": lambda one: take_in_another_thread(one.lock),
    "a thread leads": lambda one: setattr(one.steps.leading, "leader", 1),
    "a request waits": lambda one: setattr(one.alone.turns, "last", PENDING),
    "a request is queued": lambda one: one.exchange.enqueue(PENDING),
    "a reply is outstanding": lambda one: one.alone.outstanding_replies.expect_late(
        SimpleNamespace(request=PENDING.request, attempt_times=(0.0,), policy=RetryPolicy()),  # type: ignore[arg-type]
        0,
    ),
    "an acknowledgement is waited for": lambda one: one.alone.acks.waiting.append(None),  # type: ignore[arg-type]
    "a request is alone": lambda one: setattr(
        one.alone, "begun", (PENDING.request, 0.0, 0, RetryPolicy().grace)
    ),
    "the line is not aligned": lambda one: setattr(one.exchange.alignment, "align", b"x"),
}


@pytest.mark.parametrize("why", BUSY)
def test_request_that_is_not_alone_is_not_sent_and_changes_nothing(
    swapping: Swapping, why: str
) -> None:
    BUSY[why](swapping)
    before = swapping.steps.leading.leader, swapping.alone.begun, swapping.framer.fed
    assert swapping.call() is None
    assert (swapping.steps.leading.leader, swapping.alone.begun, swapping.framer.fed) == before
    assert swapping.exchange.alignment.last_request == b""
    swapping.peer.setblocking(False)
    with pytest.raises(BlockingIOError):
        swapping.peer.recv(99)
    assert not swapping.writing.locked()
    if why != "a thread reads":
        assert not swapping.steps.reading._is_owned()  # type: ignore[attr-defined]


def test_copy_of_a_one_way_request_is_not_taken_for_the_reply(swapping: Swapping) -> None:
    stop = EncodedRequest(TABLE.command("stop"), ANGLES, b"", {})
    swapping.exchange.send_one_way(stop, time.monotonic())
    swapping.alone.outstanding_replies.replies = ()
    answering = swapping.answer_with(ANGLES)
    [frame] = swapping.swap()
    answering.join()
    assert frame.data == ANGLES


def test_swap_returns_no_events_after_its_time_at_the_end_or_by_the_alarm(
    swapping: Swapping,
) -> None:
    started = time.monotonic()
    assert swapping.swap(timeout=0.05) == []
    assert time.monotonic() - started >= 0.05
    os.eventfd_write(swapping.alarm, 1)
    assert swapping.swap(timeout=60) == []
    swapping.peer.close()
    assert swapping.swap(timeout=60) is None
    swapping.loan = None
    assert swapping.swap(timeout=60) is None
    assert time.monotonic() - started < 30


def test_rest_of_a_request_is_written_with_the_lock_held(swapping: Swapping) -> None:
    large = bytes(10_000_000)
    assert swapping.swap(large, 0.01) == []
    [(request, written, locked)] = swapping.finished
    assert request == large
    assert 0 < written < len(large)
    assert locked
    assert not swapping.writing.locked()


def test_error_of_writing_the_rest_is_raised_and_frees_the_lock(swapping: Swapping) -> None:
    swapping.error = LinkError("port", "is stuck", 3)
    with pytest.raises(LinkError, match="is stuck"):
        swapping.swap(bytes(10_000_000), 0.01)
    assert not swapping.writing.locked()


def test_noise_before_a_reply_is_an_event(swapping: Swapping) -> None:
    answering = swapping.answer_with(b"boot\r\n" + ANGLES)
    noise, frame = swapping.swap()
    answering.join()
    assert isinstance(noise, Noise)
    assert frame.data == ANGLES


def test_swap_writes_at_its_moment_while_other_threads_run(swapping: Swapping) -> None:
    def answer() -> None:
        assert swapping.peer.recv(99) == REQUEST
        swapping.peer.send(ANGLES)

    others = threading.Thread(target=answer)
    others.start()
    at = time.monotonic() + 0.05
    _, requested_at, replied_at = swapping.swap(at=at)
    others.join()
    assert at <= requested_at < replied_at


def test_swap_sends_nothing_if_bytes_come_before_its_moment(swapping: Swapping) -> None:
    early = threading.Timer(0.02, swapping.peer.send, [ANGLES])
    early.start()
    assert swapping.swap(at=time.monotonic() + 0.2) is None
    early.join()
    assert swapping.ours.recv(99) == ANGLES


@pytest.mark.parametrize("event", ["a thread writes", "a thread wrote", "the alarm"])
def test_swap_sends_nothing_if_something_happens_before_its_moment(
    swapping: Swapping, event: str
) -> None:
    def happen() -> None:
        if event == "the alarm":
            os.eventfd_write(swapping.alarm, 1)
            return
        swapping.writing.acquire()
        if event == "a thread wrote":
            swapping.writing.release()

    happening = threading.Timer(0.02, happen)
    happening.start()
    assert swapping.swap(at=time.monotonic() + (60 if event == "the alarm" else 0.1)) is None
    happening.join()
    swapping.peer.setblocking(False)
    with pytest.raises(BlockingIOError):
        swapping.peer.recv(99)
    assert swapping.writing.locked() == (event == "a thread writes")


def test_signal_handler_ends_the_wait_for_the_moment(swapping: Swapping) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        with pytest.raises(KeyboardInterrupt):
            swapping.swap(at=time.monotonic() + 60)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert swapping.writing.taken == 0
    assert not swapping.sent


def test_line_lock_is_held_by_one_thread_at_a_time() -> None:
    lock: Any = line_lock()
    inside: list[int] = []
    most: list[int] = []

    def work(number: int) -> None:
        for _ in range(200):
            with lock:
                inside.append(number)
                time.sleep(0)
                most.append(len(inside))
                inside.remove(number)

    threads = [threading.Thread(target=work, args=[number]) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1] * 800
    assert lock.taken == 800
    assert lock.acquire()
    assert not lock.acquire(blocking=False)
    lock.release()
    with pytest.raises(RuntimeError):
        lock.release()
