"""A behaviour emits events: clients, monitors, recordings and `decode` receive them."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from typing import Any

import pytest

from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import (
    MemoryTransport,
    SimulatedArm,
    SteppedClock,
    TcpServer,
)
from cobotwire.simulator.behaviour import Behaviours
from trial_specs import FOOTED, HEAD, package_of

SPEC = f"""
{HEAD}
joints: 1
{FOOTED}
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
  quantities:
    number: {{wire: byte, range: [0, 9], doc: A number.}}
  texts:
    word: {{size: [0, 6], doc: A word.}}
  values:
    angles: {{class: Angles, doc: The angle., items: {{j1: number}}}}
commands:
  arm_timer:
    {{id: 1, title: Arm, doc: Arms the timer., safety: setting,
     request: [{{name: seconds, type: number}}]}}
  get_angles:
    {{id: 2, title: Angle, doc: Reads the angle., safety: query, role: joints,
     reply: [{{name: angles, type: angles}}]}}
  timer_ended:
    {{id: 3, title: Timer, doc: The timer has ended., safety: query, event: true,
     reply: [{{name: seconds, type: number}}, {{name: word, type: word}}]}}
"""


@pytest.fixture(scope="module")
def timer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with package_of(SPEC, tmp_path_factory.mktemp("timer")) as package:
        yield package


@pytest.fixture(scope="module")
def behaviours(timer: Any) -> Behaviours:
    """Let the device report the request at once, and again when its seconds are over."""
    found = Behaviours()
    messages = importlib.import_module(f"{timer.__name__}.messages")

    @found.behaviour(messages.ArmTimer)
    def arm_timer(device: Any, now: float, request: Any) -> None:
        device.emit(timer.TimerEnded(request.seconds, "armed"), now)
        device.emit(timer.TimerEnded(request.seconds, "ended"), now + request.seconds)

    return found


def test_events_come_at_their_times(timer: Any, behaviours: Behaviours) -> None:
    clock = SteppedClock()
    arm = SimulatedArm(timer.TABLE, clock=clock, behaviours=behaviours)
    with timer.Trial(MemoryTransport(arm, clock), on_error="leave") as client:
        with client.events(timer.TimerEnded, timeout=20.0) as events:
            client.arm_timer(5)
            client.arm_timer(2)
            times = {}
            for event in events:
                times[event.seconds, event.word] = pytest.approx(clock(), abs=0.2)
    assert times == {(5, "armed"): 0.0, (2, "armed"): 0.0, (2, "ended"): 2.0, (5, "ended"): 5.0}


def test_restart_forgets_planned_events(timer: Any, behaviours: Behaviours) -> None:
    clock = SteppedClock()
    arm = SimulatedArm(timer.TABLE, clock=clock, behaviours=behaviours)
    with timer.Trial(MemoryTransport(arm, clock), on_error="leave") as client:
        with client.events(timer.TimerEnded, timeout=9.0) as events:
            client.arm_timer(5)
            assert next(iter(events)).word == "armed"
            arm.restart()
            assert list(events) == []


def test_every_client_receives_an_event_of_another_thread_once(timer: Any) -> None:
    arm = SimulatedArm(timer.TABLE)
    with TcpServer(arm.connect) as server:
        with timer.Trial(server.url) as one, timer.Trial(server.url) as other:
            every = [client.events(timer.TimerEnded, timeout=5.0) for client in (one, other)]
            assert one.get_angles() == other.get_angles()
            arm.emit(timer.TimerEnded(1, "x"))
            assert [next(iter(events)).word for events in every] == ["x", "x"]
            arm.emit(timer.TimerEnded(1, "y"), after=0.05)
            assert [next(iter(events)).word for events in every] == ["y", "y"]


def test_illegal_event_is_refused_where_it_is_emitted(timer: Any) -> None:
    arm = SimulatedArm(timer.TABLE)
    with pytest.raises(UsageError, match=r"seconds is 10; allowed: a whole number 0..9"):
        arm.emit(timer.TimerEnded(10, ""))
