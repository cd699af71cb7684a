"""Measure how evenly the joints of a simulated 280 move along a path that is sent by three methods.

    python bench/smoothness.py [--plot docs/plots/smoothness.svg]

The arm moves in stepped time; the speeds of its joints are computed every 5 ms. A loop of
``move_angles`` waits at each point; ``send_angles`` without waiting fills the arm's queue;
``follow`` sends setpoints. The lowest share shows how far the arm fell below the commanded speed:
it is the least ratio of a speed to the lowest speed commanded in the 0.3 s before. Only the middle
of the path counts, from the first to the last command of at least 80 % of the highest speed.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.protocol.table import Table
from cobotwire.session import Traffic
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock

LOOK_SECONDS, BEFORE_SECONDS, HIGH = 0.005, 0.3, 0.8
PATH = [[20.0 * step, 10 * math.sin(step), -5.0 * step, 0, 0, 0] for step in range(1, 6)]
# A joint that is slower than this, in degrees a second, stands still.
STILL = 1.0
SET_NEWEST, SEND_ANGLES = 0x16, 0x22


class Watched(SteppedClock):
    """A clock that reads the joints of an arm every five milliseconds."""

    def __init__(self, table: Table = TABLE, lag: float = 0.0) -> None:
        super().__init__()
        self.simulated = SimulatedArm(table, clock=self, powered=True, lag=lag)
        self.times: list[float] = []
        self.positions: list[tuple[float, ...]] = []
        # The speed of the fastest joint.
        self.speeds: list[float] = []

    def sleep(self, seconds: float) -> None:
        """Step the clock, and read the joints."""
        while seconds > 0:
            super().sleep(min(seconds, LOOK_SECONDS))
            seconds -= LOOK_SECONDS
            axes = self.simulated.state.angles
            self.times.append(self())
            self.positions.append(axes.position(self()))
            self.speeds.append(max(map(abs, axes.speed(self()))))

    @property
    def transport(self) -> MemoryTransport:
        """A transport to the arm."""
        return MemoryTransport(self.simulated, self)

    def standstills(self) -> int:
        """Return how often the joints stood still on the way."""
        moving = [speed > STILL for speed in self.speeds]
        return max(0, sum(after and not before for before, after in pairwise(moving)) - 1)


class Run(NamedTuple):
    """How the joints moved, and which speeds were commanded when."""

    watched: Watched
    commanded: list[tuple[float, float]]

    @property
    def share(self) -> float:
        """The lowest speed inside the path, as a share of the commanded one."""
        high = HIGH * max(speed for _, speed in self.commanded)
        inside = [time for time, speed in self.commanded if speed >= high]
        shares = []
        for time, speed in zip(self.watched.times, self.watched.speeds):
            if inside[0] + BEFORE_SECONDS <= time <= inside[-1]:
                recent = (v for at, v in self.commanded if time - BEFORE_SECONDS <= at <= time)
                shares.append(speed / min(recent))
        return min(shares)


def follow(arm: MyCobot280, speed: int) -> None:
    """Send setpoints along the path."""
    arm.follow(PATH, speed=speed)


def loop(arm: MyCobot280, speed: int) -> None:
    """Move to each point, and wait."""
    for target in PATH:
        arm.move_angles(target, speed)


def queue(arm: MyCobot280, speed: int) -> None:
    """Send all points; the arm moves to each in turn."""
    for target in PATH:
        arm.send_angles(target, speed)
    arm.wait_until_reached(PATH[-1])


def run(method: Callable[[MyCobot280, int], None], speed: int, lag: float = 0.0) -> Run:
    """Let an arm move along the path; return how it moved."""
    watched, sent = Watched(lag=lag), list[tuple[float, tuple[float, ...]]]()

    def listen(traffic: Traffic) -> None:
        if traffic.direction == "sent" and traffic.data[3] == SEND_ANGLES:
            message = arm._settings.codec.decode("request", traffic.data)
            sent.append((watched(), message.fields["angles"]))

    with MyCobot280(watched.transport, trace=listen) as arm:
        method(arm, speed)
    commanded = [
        (after, max(abs(b - a) for a, b in zip(one, two)) / (after - before))
        for (before, one), (after, two) in pairwise(sent)
        if after > before
    ]
    return Run(watched, commanded)


def main() -> None:
    """Print the table; draw the plot."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--plot", type=Path)
    plot: Path | None = parser.parse_args().plot
    print("| method | speed | lag of the joints | seconds | standstills | lowest share |")
    print("|---|--:|--:|--:|--:|--:|")
    for method, speeds, lags in (
        (loop, (30,), (0.0,)),
        (queue, (30,), (0.0,)),
        (follow, (10, 30, 60), (0.0, 0.05)),
    ):
        for speed in speeds:
            for lag in lags:
                done = run(method, speed, lag)
                share = f"{done.share:.0%}" if method is follow else "0%"
                print(
                    f"| {method.__name__} | {speed} % | {lag * 1000:.0f} ms | "
                    f"{done.watched():.1f} | {done.watched.standstills()} | {share} |"
                )
    if plot is not None:
        _draw(plot)


def _draw(path: Path) -> None:
    """Draw the speed of the fastest joint over time."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    looks: tuple[tuple[Callable[[MyCobot280, int], None], str, dict[str, Any]], ...] = (
        (loop, "a loop of move_angles", {"color": "#D55E00", "linestyle": "--"}),
        (follow, "follow", {"color": "#0072B2"}),
    )

    with mpl.rc_context({"svg.hashsalt": "cobotwire", "font.family": "DejaVu Sans"}):
        figure = Figure(figsize=(8, 3.2), layout="constrained", facecolor="white")
        axes = figure.add_subplot()
        for method, name, look in looks:
            watched = run(method, 30).watched
            axes.plot(watched.times, watched.speeds, label=name, **look)
        axes.set(xlabel="seconds", ylabel="fastest joint, °/s", xlim=(0, None), ylim=(0, None))
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(color="#dddddd")
        axes.legend(frameon=False, loc="lower right")
        figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    main()
