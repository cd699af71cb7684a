"""An hour of motion at 100 Hz in stepped time: the arm moves, and is asked every 10 ms.

    python bench/simulated_time.py [--minutes N]

One core, one process, no line: what the simulated arm itself takes, from a request's bytes to its
reply's. Targets follow each other without a pause. Asked once for the angles, once for the
coordinates. The limit is a minute for the hour.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from pathlib import Path

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from kinematic_samples import random_angles

PERIOD = 0.01
LIMIT = 60.0
HOUR = 3600.0
SPEED = 40


def main() -> None:
    """Measure, and print beside the limit."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=60.0)
    seconds = parser.parse_args().minutes * 60
    for name in ("get_angles", "get_coords"):
        _hour(name, round(seconds / PERIOD))


def _hour(name: str, samples: int) -> None:
    clock, rng = SteppedClock(), random.Random(100)
    arm = SimulatedArm(TABLE, clock=clock)
    codec = codecs.load(TABLE)
    question = codec.encode(name, "request", ())
    arm.receive(codec.encode("power_on", "request", ()))
    moved = 0
    before = b""
    started = time.process_time()
    for _ in range(samples):
        if not arm.state.angles.moving(clock()):
            target = [angle / 2 for angle in random_angles(rng)]
            arm.receive(codec.encode("send_angles", "request", (target, SPEED)))
        clock.sleep(PERIOD)
        answer = arm.receive(question)
        moved += answer != before
        before = answer
    taken = (time.process_time() - started) * HOUR / (samples * PERIOD)
    print(
        f"an hour at {1 / PERIOD:.0f} Hz, {name:10} {taken:6.1f} s of CPU   "
        f"{'within' if taken <= LIMIT else 'OVER'} {LIMIT:.0f} s   "
        f"({taken / HOUR * PERIOD * 1e6:.0f} us a sample, {moved / samples:.0%} of them on the way)"
    )


if __name__ == "__main__":
    main()
