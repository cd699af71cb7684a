"""The older classes drive arms that acknowledge nothing, and arms that do."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest

import cobotwire.pymycobot as layer
from cobotwire.editions import load
from cobotwire.protocol.errors import MotionTimeout
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock


class Opened:
    """An older class on a simulated arm of an edition, in stepped time."""

    def __init__(self, name: str, edition: str, errors: str = "raise") -> None:
        self.clock = SteppedClock()
        self.arm = SimulatedArm(load(edition).TABLE, clock=self.clock, powered=True)
        kind = getattr(layer, name)
        self.layer: Any = object.__new__(kind)
        transport = MemoryTransport(self.arm, self.clock)
        self.layer._open(partial(kind.NATIVE, transport), False, errors)


@pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
@pytest.mark.parametrize(("name", "result"), [("MyCobot", 1), ("MyCobotSocket", [1])])
def test_order_returns_at_once_whether_or_not_the_arm_acknowledges(
    name: str, result: object, edition: str
) -> None:
    opened = Opened(name, edition)
    before = opened.clock()
    assert opened.layer.send_angles([0, 10, 0, 0, 0, 0], 50) == result
    assert opened.clock() == before
    assert opened.layer.is_power_on() == 1


def test_motion_that_is_late_returns_0_or_raises() -> None:
    with pytest.raises(MotionTimeout):
        Opened("MyCobot", "mycobot280").layer.sync_send_angles([90, 0, 0, 0, 0, 0], 1, 0.5)
    late = Opened("MyCobot", "mycobot280", "return").layer
    assert late.sync_send_angles([90, 0, 0, 0, 0, 0], 1, 0.5) == 0
    assert late.sync_send_angles([90, 0, 0, 0, 0, 0], 100) == 1


def test_home_of_the_socket_class_waits() -> None:
    opened = Opened("MyCobotSocket", "mycobot280")
    opened.layer.sync_send_angles([20, 0, 0, 0, 0, 0], 100)
    assert opened.layer.go_home() is None
    assert all(abs(angle) < 0.1 for angle in opened.layer.get_angles())
    assert Opened("MyCobot", "mycobot280").layer.go_home() == 1


def test_chain_of_motions_returns_the_arm() -> None:
    arm = Opened("MyPalletizer", "mypalletizer260").layer
    assert arm.sync_send_angles([10, 0, 0, 0], 100).wait(0) is arm
