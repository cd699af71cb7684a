"""The main job, end to end: a simulated arm on a pty, driven through pyserial."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.driver import Traffic
from cobotwire.editions.mycobot import TABLE, Angles, Coords, MyCobot, TargetKind
from cobotwire.sim import PtyServer, SimulatedArm

# Angles and coordinates that a real arm was read at. They stand on encoder ticks.
TARGET = Angles(95.18, -0.61, -0.61, -0.61, 88.85, -1.31)
THERE = Coords(15.3, 7.9, 410.7, -90.03, 0.52, 94.04)
TOOL = Coords(0.0, 0.0, 50.0, 0.0, 0.0, 0.0)
OPENING = 60
COLOUR = (0, 0, 255)
POLL_SECONDS = 0.05
MOTION_SECONDS = 10.0


class Check(NamedTuple):
    """One answer beside the one that is right."""

    what: str
    got: Any
    right: Any

    @property
    def passed(self) -> bool:
        """Whether the answer was right."""
        return bool(self.got == self.right)


class Result(NamedTuple):
    """What the demo saw."""

    checks: tuple[Check, ...]
    traffic: tuple[Traffic, ...]

    @property
    def passed(self) -> bool:
        """Whether every answer was right."""
        return all(check.passed for check in self.checks)


def run(
    say: Callable[[str], None],
    progress: Callable[[float], None],
    codec: codecs.CodecName | None = None,
) -> Result:
    """Run the demo.

    Args:
        say: called with a line before each step.
        progress: called with the share of the motion that is done, 0..1.
        codec: the codec to drive the arm with; left out: the one in use.

    Raises:
        CobotwireError: the arm could not be reached or did not answer.
    """
    traffic: list[Traffic] = []
    simulated = SimulatedArm(TABLE)
    with (
        PtyServer(simulated) as server,
        MyCobot(server.url, codec=codec, trace=traffic.append) as arm,
    ):
        say(f"a simulated arm listens on {server.url}; opened with the {arm.codec} codec")
        checks = [*_wake(arm, say), *_move(arm, say, progress), *_gripper(arm, say)]
        say(f"setting the light to {COLOUR}, and the tool reference to {TOOL}")
        arm.set_color(*COLOUR)
        arm.set_tool_reference(TOOL)
        checks.append(Check("get_tool_reference", arm.get_tool_reference(), TOOL))
        # The document has no command that reads the light: the simulated arm itself is asked. The
        # answer above came later on the same line, so the arm has heard of the light by now.
        checks.append(Check("the arm's light", simulated.state.colour, COLOUR))
    return Result(tuple(checks), tuple(traffic))


def _wake(arm: MyCobot, say: Callable[[str], None]) -> list[Check]:
    say("powering on")
    arm.power_on()
    return [
        Check("is_power_on", arm.is_power_on(), True),
        Check("get_angles at rest", arm.get_angles(), Angles(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    ]


def _move(
    arm: MyCobot, say: Callable[[str], None], progress: Callable[[float], None]
) -> list[Check]:
    say(f"moving to {TARGET}")
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
        Check("get_angles there", arm.get_angles(), TARGET),
        Check("get_coords, as of a real arm", arm.get_coords(), THERE),
    ]


def _gripper(arm: MyCobot, say: Callable[[str], None]) -> list[Check]:
    say(f"opening the gripper to {OPENING} %")
    arm.set_gripper_value(OPENING, speed=100)
    deadline = time.monotonic() + MOTION_SECONDS
    while arm.is_gripper_moving() and time.monotonic() < deadline:
        time.sleep(POLL_SECONDS)
    return [Check("get_gripper_value", arm.get_gripper_value(), OPENING)]
