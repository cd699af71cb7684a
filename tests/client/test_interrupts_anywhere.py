"""Ctrl-C at any line of a call does not delay calls of other threads, or later calls."""

from __future__ import annotations

import linecache
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from types import FrameType
from typing import Any

import pytest

from cobotwire import MyCobot, ReplyTimeout, RetryPolicy
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
from recording_transport import RecordingTransport
from stalls import StallMeter

FOLDERS = ("client", "session", "transport", "codec/reference")
STOP = "FE FE 02 29 FA"
TIMEOUT = 0.4
# The interrupt may lose a reply that was just read. Then the request is sent again, and the next
# request like it waits until no second reply can come.
RETRY = RetryPolicy(grace=0.05)
# The extra time that the others may take to notice that the leader is gone, and to take over.
LATE = TIMEOUT + RETRY.grace + 0.1


class InterruptAt:
    """A trace function that raises KeyboardInterrupt at the n-th line of our own code.

    At two kinds of lines it does not raise, because nothing is called there, so Python handles no
    signal: a ``try``, and the line of a ``with`` statement that Python reports again before it
    leaves the block. An exception there would skip ``__exit__``, which a signal cannot.
    """

    def __init__(self, number: int) -> None:
        self._left = number
        # Where it raised.
        self.line = ""
        self._lines: dict[FrameType, int] = {}

    @property
    def reached(self) -> bool:
        return self._left <= 0

    def __call__(self, frame: FrameType, event: str, argument: Any) -> Any:
        if not any(f"cobotwire/{folder}/" in frame.f_code.co_filename for folder in FOLDERS):
            return None
        # Python reports an exception of __del__ and continues: no caller gets the exception.
        if frame.f_code.co_name == "__del__":
            return None
        if event == "line" and not self._calls_nothing(frame):
            self._left -= 1
            if self._left == 0:
                self.line = f"{frame.f_code.co_filename}:{frame.f_lineno}"
                raise KeyboardInterrupt
        return self

    def _calls_nothing(self, frame: FrameType) -> bool:
        line, before = frame.f_lineno, self._lines.get(frame, 0)
        self._lines[frame] = line
        text = linecache.getline(frame.f_code.co_filename, line).strip()
        return text == "try:" or (before > line and text.startswith("with "))


class OtherThreads:
    """Threads that call all the time; ``slowest`` is the longest time of a call, in seconds."""

    def __init__(self, arm: MyCobot, number: int) -> None:
        self.slowest = 0.0
        self.calls = 0
        self.wrong: list[object] = []
        self._over = False
        self._threads = [
            # Their replies repeat the joint, so no thread is held for a late reply to another one.
            threading.Thread(target=self._call, args=(arm, joint))
            for joint in range(1, number + 1)
        ]

    def __enter__(self) -> OtherThreads:
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._over = True
        for thread in self._threads:
            thread.join()

    def _call(self, arm: MyCobot, joint: int) -> None:
        while not self._over:
            started = time.monotonic()
            try:
                value = arm.get_joint_max_angle(joint)
            except ReplyTimeout:
                # A correct error, in time: the interrupt lost the bytes that were just read.
                pass
            except Exception as error:
                self.wrong.append(error)
            else:
                if value != 165.0:
                    self.wrong.append(value)
            self.slowest = max(self.slowest, time.monotonic() - started)
            self.calls += 1
            time.sleep(0.002)


@contextmanager
def tracing(tracer: InterruptAt) -> Iterator[None]:
    """Trace a block, and catch the interrupt that the tracer raises in it."""
    try:
        sys.settrace(tracer)
        yield
        # An interrupt at the last line of the block is raised only here.
        time.sleep(0)
    except KeyboardInterrupt:
        pass
    finally:
        sys.settrace(None)


def interrupted(call: Callable[[], object], number: int) -> bool:
    """Make a call with an interrupt at its n-th line; return whether it has that many lines."""
    tracer = InterruptAt(number)
    with tracing(tracer):
        call()
    return tracer.reached


CALLS: dict[str, Callable[[MyCobot], object]] = {
    "a query": lambda arm: arm.get_joint_min_angle(6),
    "a one-way request": lambda arm: arm.set_color(1, 2, 3),
    "listening": lambda arm: arm.listen(0.001),
}


class Lines:
    """The numbers of the lines at which to interrupt a call, until calls have fewer lines.

    Which lines a call runs depends on the other threads, so one short call is not the end. With the
    reference codec a call runs many lines, of which every fifth is interrupted. When a call listens
    for 1 ms, the number of lines depends on the machine, so each of them is interrupted.
    """

    def __init__(self, codec: str, name: str = "a query") -> None:
        self._step = 5 if codec == "reference" and name != "listening" else 1
        self.reached = 0
        self._missed = 0

    def __iter__(self) -> Iterator[int]:
        number = 0
        while self._missed < 20:
            number += self._step
            yield number

    def note(self, reached: bool) -> None:
        """Note whether the last call ran as far as its number."""
        self.reached += reached
        self._missed = 0 if reached else self._missed + 1


def always_longer(limit: float, measure: Callable[[], float]) -> bool:
    """Return whether a time is beyond its limit three times in a row.

    A machine that is busy may delay one run, and a stall that was measured counts for nothing. An
    interrupt at one line has the same effect every time, and lasting damage shows every time.
    """
    for _ in range(3):
        with StallMeter() as meter:
            seconds = measure()
        if seconds <= limit + meter.longest:
            return False
    return True


@pytest.mark.parametrize("codec", ["native", "reference"])
@pytest.mark.parametrize("name", CALLS)
def test_interrupt_at_any_line_delays_no_other_call(name: str, codec: Any) -> None:
    with (
        PtyServer(SimulatedArm(TABLE)) as server,
        MyCobot(server.url, timeout=TIMEOUT, retry=RETRY, codec=codec) as arm,
        OtherThreads(arm, 3) as others,
    ):

        def slowest_after(number: int) -> float:
            others.slowest = 0.0
            lines.note(interrupted(lambda: CALLS[name](arm), number))
            before = others.calls
            # Wait until each thread has ended its current call, and made another one.
            while others.calls < before + 6 and others.slowest < 5:
                time.sleep(0.001)
            return others.slowest

        lines = Lines(codec, name)
        late = [n for n in lines if always_longer(LATE, partial(slowest_after, n))]
    assert lines.reached > 10, "the call has lines to interrupt"
    assert not late, f"{len(late)} of {lines.reached} interrupts delayed others"
    assert not others.wrong


@pytest.mark.parametrize("codec", ["native", "reference"])
def test_calls_after_an_interrupt_are_as_fast_as_before(codec: Any) -> None:
    with (
        PtyServer(SimulatedArm(TABLE)) as server,
        MyCobot(server.url, timeout=TIMEOUT, retry=RETRY, codec=codec) as arm,
    ):

        def seconds_after(number: int) -> float:
            lines.note(interrupted(lambda: arm.get_joint_min_angle(6), number))
            started = time.monotonic()
            assert arm.get_joint_max_angle(1) == 165.0
            return time.monotonic() - started

        lines = Lines(codec)
        # Less than a second attempt takes.
        slow = [n for n in lines if always_longer(0.12, partial(seconds_after, n))]
    assert lines.reached > 20
    assert not slow


@pytest.mark.parametrize("error", [None, ValueError("own"), KeyboardInterrupt()])
def test_second_ctrl_c_at_any_line_neither_keeps_the_arm_moving_nor_the_port_open(
    error: BaseException | None,
) -> None:
    number = reached = 0
    while True:
        number += 1
        transport = RecordingTransport()
        arm = MyCobot(transport)
        tracer = InterruptAt(number)
        with tracing(tracer):
            arm.__exit__(None if error is None else type(error), error, None)
        if not tracer.reached:
            break
        reached += 1
        assert transport.closed, tracer.line
        assert bytes.fromhex(STOP) in transport.written or error is None, tracer.line
    assert reached > 20
