"""Drive a simulated arm on a pseudo-terminal (on Windows, over TCP), and check its replies."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.client import Traffic
from cobotwire.editions.mycobot import TABLE, Angles, Coords, MyCobot, TargetKind
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.local import local_server

# Angles and coordinates that were read from a real arm. The angles are whole encoder ticks.
TARGET = Angles(95.18, -0.61, -0.61, -0.61, 88.85, -1.31)
COORDS_AT_TARGET = Coords(15.3, 7.9, 410.7, -90.03, 0.52, 94.04)
TOOL = Coords(0.0, 0.0, 50.0, 0.0, 0.0, 0.0)
OPENING = 60
COLOUR = (0, 0, 255)
POLL_SECONDS = 0.05
MOTION_SECONDS = 10.0


class Check(NamedTuple):
    """A value that the arm reported, and the value that it should report."""

    what: str
    found: Any
    expected: Any

    @property
    def passed(self) -> bool:
        """Whether the value is right."""
        return bool(self.found == self.expected)


class Result(NamedTuple):
    """The checks of the demo, and all traffic."""

    checks: tuple[Check, ...]
    traffic: tuple[Traffic, ...]

    @property
    def passed(self) -> bool:
        """Whether every value is right."""
        return all(check.passed for check in self.checks)


def run(
    report: Callable[[str], None],
    progress: Callable[[float], None],
    codec: codecs.CodecName | None = None,
) -> Result:
    """Run the demo.

    Args:
        report: called with a sentence before each step.
        progress: called with the completed share of the motion, 0..1.
        codec: the client's codec; None chooses the default one.

    Raises:
        CobotwireError: the arm could not be reached, or it did not reply.
    """
    traffic: list[Traffic] = []
    simulated = SimulatedArm(TABLE)
    with (
        local_server(simulated) as server,
        MyCobot(server.url, codec=codec, trace=traffic.append) as arm,
    ):
        report(f"connected to a simulated arm at {server.url} with the {arm.codec} codec")
        checks = [*_power_on(arm, report), *_move(arm, report, progress), *_grip(arm, report)]
        report(f"setting the light to {COLOUR} and the tool reference to {TOOL}")
        arm.set_color(*COLOUR)
        arm.set_tool_reference(TOOL)
        checks.append(Check("get_tool_reference", arm.get_tool_reference(), TOOL))
        # No command reads the light, so its state is taken from the simulated arm. The reply above
        # came after set_color on the same port, so the arm has processed set_color by now.
        checks.append(Check("the arm's light", simulated.state.light, COLOUR))
    return Result(tuple(checks), tuple(traffic))


def _power_on(arm: MyCobot, report: Callable[[str], None]) -> list[Check]:
    report("powering on")
    arm.power_on()
    return [
        Check("is_power_on", arm.is_power_on(), True),
        Check("get_angles at rest", arm.get_angles(), Angles(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    ]


def _move(
    arm: MyCobot, report: Callable[[str], None], progress: Callable[[float], None]
) -> list[Check]:
    report(f"moving to {TARGET}")
    arm.send_angles(TARGET, speed=40)
    way = max(abs(angle) for angle in TARGET)
    deadline = time.monotonic() + MOTION_SECONDS
    reached = False
    while not reached and time.monotonic() < deadline:
        left = max(abs(a - b) for a, b in zip(arm.get_angles(), TARGET))
        progress(1 - left / way)
        time.sleep(POLL_SECONDS)
        reached = arm.is_in_position(TARGET, TargetKind.ANGLES) and not arm.is_moving()
    progress(1.0)
    return [
        Check("is_in_position", reached, True),
        Check("get_angles at the target", arm.get_angles(), TARGET),
        Check("get_coords at the target, as on a real arm", arm.get_coords(), COORDS_AT_TARGET),
    ]


def _grip(arm: MyCobot, report: Callable[[str], None]) -> list[Check]:
    report(f"opening the gripper to {OPENING} %")
    arm.set_gripper_value(OPENING, speed=100)
    deadline = time.monotonic() + MOTION_SECONDS
    while arm.is_gripper_moving() and time.monotonic() < deadline:
        time.sleep(POLL_SECONDS)
    return [Check("get_gripper_value", arm.get_gripper_value(), OPENING)]
