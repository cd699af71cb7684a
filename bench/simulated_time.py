"""Measure an hour of motion in stepped time, with a query every 10 ms.

    python bench/simulated_time.py [--minutes N]

It runs in one process without a transport, so it measures only the simulated arm, from the bytes of
a request to those of its reply. Targets follow each other without a pause. The queries are
get_angles in one run and get_coords in another. The hour may take at most one minute.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from pathlib import Path

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from kinematic_samples import random_angles

PERIOD = 0.01
LIMIT = 60.0
HOUR = 3600.0
SPEED = 40


def main() -> None:
    """Measure both runs; print their times with the limit."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=60.0)
    seconds = parser.parse_args().minutes * 60
    for name in ("get_angles", "get_coords"):
        _hour(name, round(seconds / PERIOD))


def _hour(name: str, samples: int) -> None:
    clock, rng = SteppedClock(), random.Random(100)  # noqa: S311  (samples, no secrets)
    arm = SimulatedArm(TABLE, clock=clock)
    codec = codecs.load(TABLE)
    query = codec.encode(name, "request", ())
    arm.receive(codec.encode("power_on", "request", ()))
    moved = 0
    before = b""
    started = time.process_time()
    for _ in range(samples):
        if not arm.state.angles.moving(clock()):
            target = [angle / 2 for angle in random_angles(rng)]
            arm.receive(codec.encode("send_angles", "request", (target, SPEED)))
        clock.sleep(PERIOD)
        reply = arm.receive(query)
        moved += reply != before
        before = reply
    taken = (time.process_time() - started) * HOUR / (samples * PERIOD)
    print(
        f"an hour at {1 / PERIOD:.0f} Hz, {name:10} {taken:6.1f} s of CPU   "
        f"{'within' if taken <= LIMIT else 'OVER'} {LIMIT:.0f} s   "
        f"({taken / HOUR * PERIOD * 1e6:.0f} us a sample, {moved / samples:.0%} of them in motion)"
    )


if __name__ == "__main__":
    main()
