"""The maker's unmodified classes drive simulated arms that acknowledge setters, or do not.

An arm of the edition mycobot acknowledges no setter. The classes wait for a reply all the same.
So they send each setter three times, take 1.5 s and return -1, although the arm obeys.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import pytest

from cobotwire.session import RequestReceived
from cobotwire.simulator import SimulatedArm
from kinematic_samples import ENCODERS
from robots.classes import ROBOTS
from robots.driving import ArmPort, stepped

UNANSWERED, DONE = -1, 1
# A joint stops on an encoder tick, so it is off by up to half a tick.
HALF_TICK = 0.044


class Driven:
    """A class of the maker's, the arm that it drives, and what that arm received and rejected."""

    def __init__(self, peer: str, edition: str, clock: Any) -> None:
        self.received: list[str] = []
        robot = replace(ROBOTS[peer], edition=edition)
        self.clock = clock
        self.arm = SimulatedArm(robot.table, clock=clock.time, powered=True, on_event=self._record)
        self.peer = robot.on(ArmPort(self.arm, clock))

    @property
    def angles(self) -> tuple[float, ...]:
        """The joint angles after a minute, when no motion lasts."""
        self.clock.sleep(60.0)
        return self.arm.state.standing(self.clock.now)

    def _record(self, event: Any, reply: bytes) -> None:
        known = isinstance(event, RequestReceived)
        self.received.append(event.message.command.name if known else "unknown")


@contextmanager
def driven(peer: str, edition: str) -> Iterator[Driven]:
    """Drive a simulated arm of an edition with a class, in stepped time."""
    with stepped() as clock:
        yield Driven(peer, edition, clock)


@pytest.mark.parametrize(
    ("edition", "peer", "times", "result", "seconds"),
    [("mycobot", "MyCobot", 3, UNANSWERED, 1.5), ("mycobot280", "MyCobot280", 1, DONE, 0.0)],
)
def test_setter_without_acknowledgement_is_sent_three_times_and_each_moves_the_arm(
    edition: str, peer: str, times: int, result: int, seconds: float
) -> None:
    with driven(peer, edition) as found:
        start = found.clock.now
        assert found.peer.set_color(255, 128, 1) == result
        assert found.clock.now - start == pytest.approx(seconds, abs=0.15)
        assert (found.received, found.arm.state.light) == (["set_color"] * times, (255, 128, 1))
        # This is why cobotwire never sends a motion twice.
        assert found.peer.jog_increment(1, 10, 100) == result
        assert found.angles[0] == pytest.approx(10.0 * times, abs=2 * HALF_TICK)
        assert found.peer.get_angles()[0] == pytest.approx(10.0 * times, abs=0.1)
        assert found.received.count("get_angles") == 1


def test_pymycobot_truncates_an_angle_that_our_client_rounds() -> None:
    with driven("MyCobot280", "mycobot280") as found:
        found.peer.send_angle(1, 0.58, 100)
        # 0.58 is sent as 0.57, which is nearer to the sixth tick than to the seventh.
        assert found.angles[0] == 6 * ENCODERS.degrees != pytest.approx(0.58, abs=0.05)


@pytest.mark.parametrize("which", ["tool", "world"])
@pytest.mark.parametrize(("edition", "factor"), [("mycobot", 0.1), ("mycobot280", 1.0)])
def test_reference_reads_back_as_sent_although_a_tenth_of_it_may_arrive(
    which: str, edition: str, factor: float
) -> None:
    # Disputed: the class writes and reads x, y and z in tenths, the document has hundredths.
    reference = [100, 20.5, -30, 45, 0, -90]
    with driven("MyCobot280", edition) as found:
        getattr(found.peer, f"set_{which}_reference")(reference)
        assert getattr(found.peer, f"get_{which}_reference")() == reference
        arrived = [*(factor * each for each in reference[:3]), *reference[3:]]
        assert found.arm.state.kept[which] == pytest.approx(arrived)


def test_joint_limit_arrives_ten_times_too_small_and_reads_back_too_small() -> None:
    # Disputed: the class writes limits in tenths, the document has hundredths. Both read tenths.
    with driven("MyCobot280", "mycobot") as found:
        found.peer.set_joint_max(1, 90)
        assert found.arm.state.maximum[0] == found.peer.get_joint_max_angle(1) == 9.0
        found.peer.send_angle(1, 45, 100)
        assert found.angles[0] == 0.0


def test_joint_limits_read_as_unconverted_tenths() -> None:
    with driven("MyCobot", "mycobot") as found:
        found.arm.state.minimum[2], found.arm.state.maximum[2] = -150.5, 150.5
        limits = found.peer.get_joint_min_angle(3), found.peer.get_joint_max_angle(3)
        assert limits == (-1505, 1505)
