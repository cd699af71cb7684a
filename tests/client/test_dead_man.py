"""A dead man's switch stops the arm once for each silence, and only then."""

from __future__ import annotations

import asyncio
import time
from math import inf

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import AsyncDeadMan, DeadMan, LinkError, UsageError
from cobotwire.client.dead_man import Silence
from cobotwire.editions.myarm_c650 import MyArmC650
from cobotwire.editions.mybuddy import MyBuddy
from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
from cobotwire.session import Traffic
from cobotwire.simulator import SteppedClock
from recording_transport import RecordingTransport

STOP = bytes.fromhex("FE FE 02 29 FA")


class SteppedTransport(RecordingTransport):
    """A transport with a clock that the test steps."""

    def __init__(self) -> None:
        super().__init__()
        self.clock = SteppedClock()


def _stops(dead_man: DeadMan, count: int) -> bool:
    """Return whether the arm was stopped ``count`` times within two seconds."""
    ends = time.monotonic() + 2
    while dead_man.stops < count and time.monotonic() < ends:
        time.sleep(0.005)
    return dead_man.stops == count


@given(st.lists(st.tuples(st.floats(0, 3), st.sampled_from(["alive", "rest", "look"]))))
def test_silence_ends_once_and_only_after_its_seconds(events: list[tuple[float, str]]) -> None:
    silence, now, fed, stops, expected = Silence(1.0), 0.0, inf, 0, 0
    for gap, event in events:
        now += gap
        # The owner of the switch acts as soon as the time is over, before the next event.
        if silence.left(now) <= 0:
            silence.rest()
            stops += 1
        if now - fed >= 1.0:
            expected, fed = expected + 1, inf
        if event == "alive":
            silence.alive(now)
            fed = now
        elif event == "rest":
            silence.rest()
            fed = inf
    assert stops == expected


def test_thread_stops_the_arm_once_for_each_silence_of_the_transports_clock() -> None:
    transport = SteppedTransport()
    with MyCobot280(transport, on_error="leave") as arm, DeadMan(arm, 1.0) as dead_man:
        for _ in range(3):
            transport.clock.sleep(0.9)
            dead_man.alive()
        time.sleep(0.1)
        assert transport.written == b"", "it was fed in time"
        for count in (1, 2):
            transport.clock.sleep(1.1)
            assert _stops(dead_man, count)
            transport.clock.sleep(50)
            time.sleep(0.1)
            assert transport.written == STOP * count
            dead_man.alive()
        dead_man.rest()
        transport.clock.sleep(50)
        time.sleep(0.1)
    transport.clock.sleep(50)
    assert transport.written == STOP * 2


def test_task_stops_the_arm_once_for_each_silence() -> None:
    transport = RecordingTransport()

    async def main() -> None:
        async with AsyncMyCobot280(transport) as arm, AsyncDeadMan(arm, 0.2) as dead_man:
            for _ in range(6):
                await asyncio.sleep(0.05)
                dead_man.alive()
            assert transport.written == b""
            await asyncio.sleep(0.5)
            assert dead_man.stops == 1
            dead_man.alive()
            await asyncio.sleep(0.3)
            assert transport.written == STOP * 2
            dead_man.alive()
            dead_man.rest()
            await asyncio.sleep(0.3)
        assert transport.written == STOP * 2

    asyncio.run(main())


def test_every_address_that_was_used_is_stopped() -> None:
    transport = SteppedTransport()
    with MyBuddy(transport, address=MyBuddy.LEFT) as arm, DeadMan(arm, 1.0) as dead_man:
        arm.right  # noqa: B018  (used)
        transport.clock.sleep(2)
        assert _stops(dead_man, 1)
    assert transport.written == bytes.fromhex("FE FE 01 02 29 29 FE FE 02 02 29 29")


def test_stop_that_could_not_be_sent_is_reported_by_the_next_sign_of_life() -> None:
    transport = SteppedTransport()

    def fail(data: bytes) -> None:
        raise LinkError("recorder", "the cable is out")

    with MyCobot280(transport) as arm, DeadMan(arm, 1.0) as dead_man:
        transport.write = fail  # type: ignore[method-assign]
        transport.clock.sleep(2)
        assert _stops(dead_man, 1)
        with pytest.raises(LinkError, match="the cable is out"):
            dead_man.alive()
        dead_man.alive()
        dead_man.rest()


def test_listener_that_raises_does_not_end_the_thread_and_no_address_is_left_out() -> None:
    transport = SteppedTransport()

    def fail(traffic: Traffic) -> None:
        raise ZeroDivisionError("a listener")

    stops = bytes.fromhex("FE FE 01 02 29 29 FE FE 02 02 29 29")
    with MyBuddy(transport, address=MyBuddy.LEFT) as arm, DeadMan(arm, 1.0) as dead_man:
        arm.right  # noqa: B018  (used)
        remove = arm.add_traffic_listener(fail)
        for count in (1, 2):
            transport.clock.sleep(2)
            assert _stops(dead_man, count)
            assert transport.written == stops * count
            with pytest.raises(ZeroDivisionError, match="a listener"):
                dead_man.alive()
        remove()
        dead_man.rest()


def test_unexpected_error_of_a_stop_does_not_end_the_task() -> None:
    transport = RecordingTransport()

    async def fail() -> None:
        raise ZeroDivisionError("a listener")

    async def main() -> None:
        async with AsyncMyCobot280(transport) as arm, AsyncDeadMan(arm, 0.05) as dead_man:
            stop_all = arm._stop_all
            arm._stop_all = fail  # type: ignore[method-assign]
            await asyncio.sleep(0.2)
            assert dead_man.stops == 1
            arm._stop_all = stop_all  # type: ignore[method-assign]
            with pytest.raises(ZeroDivisionError, match="a listener"):
                dead_man.alive()
            await asyncio.sleep(0.2)
            assert dead_man.stops == 2

    asyncio.run(main())
    assert transport.written == STOP


def test_listener_that_raises_does_not_keep_a_call_waiting() -> None:
    errors = []

    def fail(traffic: Traffic) -> None:
        raise ZeroDivisionError("a listener")

    async def main() -> None:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: errors.append(context["exception"]))
        async with asyncio.timeout(2), AsyncMyCobot280(RecordingTransport(), trace=fail) as arm:
            await arm.stop()

    asyncio.run(main())
    assert [type(error) for error in errors] == [ZeroDivisionError]


def test_seconds_and_the_edition_are_checked_first() -> None:
    with pytest.raises(UsageError, match="seconds is 0; allowed: "):
        DeadMan(MyCobot280(RecordingTransport()), 0)
    with pytest.raises(UsageError, match="no command with the role 'stop'"):
        DeadMan(MyArmC650(RecordingTransport()), 1.0)
