"""How soon a wait notices that a motion has ended, and how many queries it sends."""

from __future__ import annotations

from copy import deepcopy
from importlib import import_module
from random import Random
from statistics import median
from typing import Any

import pytest

from cobotwire import MotionTimeout, editions
from cobotwire import codec as codecs
from cobotwire.protocol.roles import ANGLES, kinds_of, reached_query
from cobotwire.session import AckReceived, Traffic
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire.simulator.faults import Fault, Late, Lost, Scenario

# An edition with a query for the target, one that only reports the position, and one that reports
# the end of motions.
REPRESENTATIVE = ("mycobot280", "myarm_m750", "mercury_a1")
MOTIONS = 200
# How many queries a wait may send in a second, whenever it begins.
MOST_QUERIES = 12
# How much a joint may move at rest by the edition's tolerances, and a tick of the encoders.
TICK = 0.05


class Arm:
    """A client in stepped time on a simulated arm, with faults on its line."""

    def __init__(self, name: str, *faults: Fault) -> None:
        package: Any = import_module(f"cobotwire.editions.{name}")
        self.table = package.TABLE
        self.clock = SteppedClock()
        simulated = SimulatedArm(self.table, clock=self.clock, powered=True)
        codec = codecs.load(self.table)
        peer = Scenario(name="line", faults=faults).wrap(simulated, codec, clock=self.clock)
        self.traffic: list[Traffic] = []
        client = package.CLIENT(MemoryTransport(peer, self.clock), trace=self.traffic.append)
        self.client = client.left if hasattr(client, "left") else client
        address = self.client._address if self.client is not client else None
        self.state = simulated.state if address is None else simulated.states[address.value]
        self.near = 0.5 if reached_query(self.table) is None else self.state.near[0]

    def move(self, target: list[float], speed: int) -> float:
        """Move the arm, and wait; return how long after the end the wait returned."""
        self.client.move_angles(target, speed, wait=False)
        self.traffic.clear()
        ended = self.end(target)
        kind = kinds_of(self.table)[ANGLES]
        self.client.wait_until_reached(target, kind, timeout=60)
        there = self.state.standing(self.clock())
        assert self.distance(there, target) <= self.near + TICK, "the arm is there"
        return self.clock() - ended

    def end(self, target: list[float]) -> float:
        """Return when the motion will end: at rest for editions with an event, else near the
        target."""
        axes, time = self.state.angles, self.clock()
        for step in (0.2, 0.02, 0.002):
            ahead = deepcopy(axes)
            while (
                ahead.moving(time)
                if self.table.find_role("motion ended")
                else self.distance(ahead.position(time), target) > self.near
            ):
                time += step
            time -= step
        return time

    @staticmethod
    def distance(place: Any, target: list[float]) -> float:
        return max(float(abs(have - wish)) for have, wish in zip(place, target))

    def most_queries(self) -> int:
        """Return how many queries were sent in the busiest second."""
        sent = [one.time for one in self.traffic if one.direction == "sent"]
        return max(sum(at <= each < at + 1 - 1e-9 for each in sent) for at in sent)


def targets(arm: Arm, count: int) -> list[tuple[list[float], int]]:
    """Return random targets and speeds that every arm can reach."""
    draws = Random(arm.table.edition)
    home = [sum(ends) / 2 for ends in zip(arm.state.minimum, arm.state.maximum)]
    return [
        ([round(at + draws.uniform(-20, 20), 1) for at in home], draws.randint(40, 100))
        for _ in range(count)
    ]


@pytest.mark.parametrize("name", [n for n in editions.names() if n != "myarm_c650"])
def test_end_is_noticed_soon_with_few_queries_and_never_early(name: str) -> None:
    arm = Arm(name, Late(seconds=0.006, jitter_seconds=0.012))
    delays, busiest = [], 0
    for target, speed in targets(arm, MOTIONS if name in REPRESENTATIVE else 3):
        delays.append(arm.move(target, speed))
        busiest = max(busiest, arm.most_queries())
    assert busiest <= MOST_QUERIES
    assert max(delays) < 0.4
    assert len(delays) < MOTIONS or median(delays) <= 0.06


@pytest.mark.parametrize("lost", [(11, 12), (12, 13)])
def test_repeats_count_among_the_queries_of_a_second(lost: tuple[int, int]) -> None:
    arm = Arm("mycobot280", Lost(nth=lost))
    arm.move([20.0, 0.0, 0.0, 0.0, 0.0, 0.0], 100)
    assert arm.most_queries() <= MOST_QUERIES


def test_lost_replies_and_a_standstill_keep_the_limit_and_are_reported() -> None:
    arm = Arm("mycobot280", Lost(every=3))
    busiest = 0
    for target, speed in targets(arm, 20):
        arm.move(target, speed)
        busiest = max(busiest, arm.most_queries())
    arm.state.maximum[2] = 30.0
    arm.traffic.clear()
    began = arm.clock()
    with pytest.raises(MotionTimeout, match="stands still short of"):
        arm.client.move_angles([0.0, 0.0, 90.0, 0.0, 0.0, 0.0], 100)
    assert arm.clock() - began < 6
    assert max(busiest, arm.most_queries()) <= MOST_QUERIES


def test_late_acknowledgement_is_followed_by_a_query_at_once() -> None:
    arm = Arm("mycobot280", Late(seconds=3.03, commands=("send_angles",)))
    arm.client.move_angles([90.0, 0.0, 0.0, 0.0, 0.0, 0.0], 10)
    acked = next(one.time for one in arm.traffic if isinstance(one.event, AckReceived))
    sent = [one.time - acked for one in arm.traffic if one.direction == "sent"]
    assert 0 in sent
