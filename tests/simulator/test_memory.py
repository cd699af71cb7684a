"""Test the transport in memory, in stepped time and in real time."""

from __future__ import annotations

import asyncio
import threading
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import LinkError, UsageError
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.simulator import MemoryTransport, RunningClock, SimulatedArm, SteppedClock
from cobotwire.transport import TappedTransport

QUERY = bytes.fromhex("FE FE 02 20 FA")


class Late:
    """A peer that echoes each piece it received ``delay`` seconds later."""

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
        due = b""
        while self._due and self._due[0][0] <= self._clock():
            due += self._due.pop(0)[1]
        return due


def _stepped() -> tuple[MyCobot280, SteppedClock]:
    clock = SteppedClock()
    return MyCobot280(MemoryTransport(SimulatedArm(TABLE, clock=clock), clock)), clock


def test_observed_traffic_has_times_of_the_clock() -> None:
    clock = SteppedClock(50.0)
    seen: list[tuple[str, float]] = []
    transport = TappedTransport(
        MemoryTransport(Late(clock, 0.25), clock), lambda way, data, at: seen.append((way, at))
    )
    transport.write(b"x")
    assert transport.read(1.0) == b"x"
    assert seen == [("sent", 50.0), ("received", 50.25)]
    arm = MyCobot280(
        TappedTransport(MemoryTransport(SimulatedArm(TABLE, clock=clock), clock), print)
    )
    times: list[float] = []
    arm.add_traffic_listener(lambda traffic: times.append(traffic.time))
    arm.power_on()
    assert times[0] == clock()


@given(
    st.lists(st.tuples(st.binary(min_size=1, max_size=5), st.floats(0, 3)), max_size=8),
    st.floats(0, 2),
)
def test_read_waits_until_the_next_data_is_due(
    written: list[tuple[bytes, float]], delay: float
) -> None:
    """Check that data arrives once, in order, not too early, and that time never runs back."""
    clock = SteppedClock()
    transport = MemoryTransport(Late(clock, delay), clock)
    got, written_at = b"", []
    for data, timeout in written:
        before = clock()
        written_at.append(before)
        transport.write(data)
        got += transport.read(timeout)
        assert before <= clock() <= before + timeout + 1e-5
    while data := transport.read(10.0):
        got += data
        assert clock() >= written_at[0] + delay - 1e-9
    assert got == b"".join(data for data, _ in written)


def test_incomplete_request_is_given_up_across_several_short_waits() -> None:
    clock = SteppedClock()
    peer = SimulatedArm(TABLE, clock=clock)
    transport = MemoryTransport(peer, clock)
    transport.write(QUERY[:3])
    while peer.pending:
        assert transport.read(0.02) == b""
        assert clock() < 1.0
    assert clock() == pytest.approx(0.2, abs=0.021)


def test_write_in_real_time_wakes_a_waiting_read() -> None:
    transport = MemoryTransport(SimulatedArm(TABLE))
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append(transport.read(20.0)))
    reader.start()
    started = time.monotonic()
    transport.write(QUERY)
    reader.join(10.0)
    assert not reader.is_alive()
    assert time.monotonic() - started < 5.0
    assert got[0].startswith(b"\xfe\xfe\x0e\x20")


def test_close_ends_a_read_in_another_thread() -> None:
    transport = MemoryTransport(SimulatedArm(TABLE))
    errors: list[LinkError] = []

    def read() -> None:
        with pytest.raises(LinkError, match="closed meanwhile") as caught:
            transport.read(20.0)
        errors.append(caught.value)

    reader = threading.Thread(target=read)
    reader.start()
    time.sleep(0.05)
    transport.close()
    transport.close()
    reader.join(10.0)
    assert not reader.is_alive()
    assert len(errors) == 1
    for use in (
        lambda: transport.read(0),
        lambda: transport.write(b"x"),
        lambda: transport.write_some(b"x"),
    ):
        with pytest.raises(LinkError, match="it is closed"):
            use()
    transport.reopen()
    transport.write(QUERY)
    assert transport.read(0)


def test_running_clock_with_a_rate_runs_faster() -> None:
    clock = RunningClock(50.0)
    transport = MemoryTransport(Late(clock, 10.0), clock)
    started = time.monotonic()
    transport.write(b"x")
    assert transport.read(20.0) == b"x"
    assert 0.19 < time.monotonic() - started < 0.39


def test_threads_share_an_arm_in_stepped_time() -> None:
    arm, _ = _stepped()
    arm.power_on()
    right: list[bool] = []

    def query() -> None:
        right.extend(arm.is_power_on() and arm.get_angles().j1 == 0 for _ in range(50))

    threads = [threading.Thread(target=query) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20.0)
    assert right == [True] * 200


def test_asyncio_client_rejects_a_stepped_clock() -> None:
    async def drive() -> float:
        async with AsyncMyCobot280(MemoryTransport(SimulatedArm(TABLE))) as arm:
            await arm.power_on()
            await arm.move_angles([10, 0, 0, 0, 0, 0], 100)
            return (await arm.get_angles()).j1

    assert asyncio.run(drive()) == pytest.approx(10, abs=0.1)
    for clock in (SteppedClock(), RunningClock(2.0)):
        with pytest.raises(UsageError, match="real time"):
            AsyncMyCobot280(MemoryTransport(SimulatedArm(TABLE, clock=clock), clock))
