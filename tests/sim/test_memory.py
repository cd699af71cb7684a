"""A link in memory: a client and an arm in one process, in stepped time and in real time."""

from __future__ import annotations

import asyncio
import threading
import time
from itertools import islice

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import LinkError, MotionTimeout, ReplyTimeout, UsageError
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.sim import MemoryLink, RunningClock, SimulatedArm, SteppedClock
from cobotwire.transport import Link, TappedLink

ASK = bytes.fromhex("FE FE 02 20 FA")


class Late:
    """Says back what it heard, ``delay`` seconds later, piece by piece."""

    def __init__(self, clock: SteppedClock | RunningClock, delay: float) -> None:
        self._clock, self._delay = clock, delay
        self._due: list[tuple[float, bytes]] = []

    @property
    def wait(self) -> float | None:
        return max(0.0, self._due[0][0] - self._clock()) if self._due else None

    def receive(self, data: bytes) -> bytes:
        self._due.append((self._clock() + self._delay, data))
        return b""

    def flush(self) -> bytes:
        said = b""
        while self._due and self._due[0][0] <= self._clock():
            said += self._due.pop(0)[1]
        return said


def _stepped() -> tuple[MyCobot280, SteppedClock]:
    clock = SteppedClock()
    return MyCobot280(MemoryLink(SimulatedArm(TABLE, clock=clock), clock)), clock


def test_it_is_a_link() -> None:
    link = MemoryLink(SimulatedArm(TABLE))
    assert isinstance(link, Link)
    assert link.fileno() is None


def test_a_motion_of_many_seconds_is_over_at_once_and_the_clock_says_how_long_it_took() -> None:
    arm, clock = _stepped()
    arm.power_on()
    started = time.monotonic()
    arm.move_angles([100, 0, 0, 0, 0, 0], 5, timeout=60)
    assert time.monotonic() - started < 2
    assert clock() > 10
    assert arm.get_angles().j1 == pytest.approx(100, abs=0.1)


def test_a_motion_that_ends_short_takes_stepped_time_as_well() -> None:
    arm, clock = _stepped()
    with pytest.raises(MotionTimeout, match="stands still"):
        arm.move_angles([100, 0, 0, 0, 0, 0], 5, timeout=60)
    assert 1.0 <= clock() < 2.0


def test_a_question_that_is_not_answered_times_out_by_the_clock() -> None:
    clock = SteppedClock(100.0)
    arm = MyCobot280(MemoryLink(Late(clock, 1e9), clock), timeout=5.0)
    with pytest.raises(ReplyTimeout) as caught:
        arm.get_angles()
    assert caught.value.waited == pytest.approx(5.0)
    assert clock() == pytest.approx(105.0)


def test_a_stream_goes_by_the_clock_of_the_link() -> None:
    arm, clock = _stepped()
    began = clock()
    samples = list(islice(arm.stream("get_angles", rate=100), 6_001))
    assert clock() - began == pytest.approx(60.0)
    assert [sample.slot for sample in samples] == list(range(6_001))


def test_what_is_watched_and_tapped_has_the_clocks_times() -> None:
    clock = SteppedClock(50.0)
    seen: list[tuple[str, float]] = []
    link = TappedLink(
        MemoryLink(Late(clock, 0.25), clock), lambda way, data, at: seen.append((way, at))
    )
    link.write(b"x")
    assert link.read(1.0) == b"x"
    assert seen == [("sent", 50.0), ("heard", 50.25)]
    arm = MyCobot280(TappedLink(MemoryLink(SimulatedArm(TABLE, clock=clock), clock), print))
    times: list[float] = []
    arm.watch(lambda traffic: times.append(traffic.time))
    arm.power_on()
    assert times[0] == clock()


@given(
    st.lists(st.tuples(st.binary(min_size=1, max_size=5), st.floats(0, 3)), max_size=8),
    st.floats(0, 2),
)
def test_reading_waits_for_what_is_due_and_no_longer(
    said: list[tuple[bytes, float]], delay: float
) -> None:
    """Law: what was said arrives once, in order, not before its time; time goes forward."""
    clock = SteppedClock()
    link = MemoryLink(Late(clock, delay), clock)
    got, written_at = b"", []
    for data, timeout in said:
        before = clock()
        written_at.append(before)
        link.write(data)
        got += link.read(timeout)
        assert before <= clock() <= before + timeout + 1e-5
    while data := link.read(10.0):
        got += data
        assert clock() >= written_at[0] + delay - 1e-9
    assert got == b"".join(data for data, _ in said)


def test_half_a_request_is_given_up_after_its_time_even_if_nobody_waits_so_long_at_once() -> None:
    clock = SteppedClock()
    peer = SimulatedArm(TABLE, clock=clock)
    link = MemoryLink(peer, clock)
    link.write(ASK[:3])
    while peer.pending:
        assert link.read(0.02) == b""
        assert clock() < 1.0
    assert clock() == pytest.approx(0.2, abs=0.021)


def test_reading_without_waiting_steps_nothing() -> None:
    clock = SteppedClock()
    link = MemoryLink(Late(clock, 1.0), clock)
    link.write(b"x")
    assert link.read(0) == b""
    assert clock() == 0.0


def test_in_real_time_a_write_wakes_whoever_reads() -> None:
    link = MemoryLink(SimulatedArm(TABLE))
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append(link.read(20.0)))
    reader.start()
    started = time.monotonic()
    link.write(ASK)
    reader.join(10.0)
    assert not reader.is_alive()
    assert time.monotonic() - started < 5.0
    assert got[0].startswith(b"\xfe\xfe\x0e\x20")


def test_closing_ends_a_read_in_another_thread() -> None:
    link = MemoryLink(SimulatedArm(TABLE))
    errors: list[LinkError] = []

    def read() -> None:
        with pytest.raises(LinkError, match="closed meanwhile") as caught:
            link.read(20.0)
        errors.append(caught.value)

    reader = threading.Thread(target=read)
    reader.start()
    time.sleep(0.05)
    link.close()
    link.close()
    reader.join(10.0)
    assert not reader.is_alive()
    assert len(errors) == 1
    for use in (lambda: link.read(0), lambda: link.write(b"x"), lambda: link.write_some(b"x")):
        with pytest.raises(LinkError, match="it is closed"):
            use()
    link.reopen()
    link.write(ASK)
    assert link.read(0)


def test_real_time_may_run_faster() -> None:
    clock = RunningClock(50.0)
    link = MemoryLink(Late(clock, 10.0), clock)
    started = time.monotonic()
    link.write(b"x")
    assert link.read(20.0) == b"x"
    assert 0.19 < time.monotonic() - started < 0.39


def test_threads_share_an_arm_in_stepped_time() -> None:
    arm, _ = _stepped()
    arm.power_on()
    right: list[bool] = []

    def ask() -> None:
        right.extend(arm.is_power_on() and arm.get_angles().j1 == 0 for _ in range(50))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20.0)
    assert right == [True] * 200


def test_asyncio_takes_real_time_alone() -> None:
    async def drive() -> float:
        async with AsyncMyCobot280(MemoryLink(SimulatedArm(TABLE))) as arm:
            await arm.power_on()
            await arm.move_angles([10, 0, 0, 0, 0, 0], 100)
            return (await arm.get_angles()).j1

    assert asyncio.run(drive()) == pytest.approx(10, abs=0.1)
    for clock in (SteppedClock(), RunningClock(2.0)):
        with pytest.raises(UsageError, match="real time"):
            AsyncMyCobot280(MemoryLink(SimulatedArm(TABLE, clock=clock), clock))
