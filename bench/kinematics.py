"""Measure inverse and then forward kinematics of 10,000 random poses within reach.

    python bench/kinematics.py [--poses N]

Each pose comes from random angles inside the limits of the edition mycobot280; the search starts at
other random angles. The bench tries each pose unchanged, and again truncated to the wire's steps as
in get_coords, which may put it slightly out of reach. Last, it counts how many random coordinates
inside the edition's limits are reachable.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from pathlib import Path

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.kinematics import Pose, flange, nearest

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from kinematic_samples import LIMITS, MYCOBOT_280, random_angles, reported_coords, within_limits

MILLIMETRES, DEGREES = 0.1, 0.02


def main() -> None:
    """Measure the poses; print the errors with their limits."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--poses", type=int, default=10_000)
    poses: int = parser.parse_args().poses
    rng = random.Random(280)  # noqa: S311  (samples, no secrets)
    exact = [flange(MYCOBOT_280, random_angles(rng)) for _ in range(poses)]
    _round_trip("unchanged", exact, rng, limited=True)
    reported = [Pose.of(reported_coords(pose.coords)) for pose in exact]
    _round_trip("as get_coords reports them", reported, rng, limited=False)
    numbers = TABLE.in_role("coordinate targets").request[0].fields[0].cases[0].numbers
    box = [(number.physical(number.minimum), number.physical(number.maximum)) for number in numbers]
    anywhere = [Pose.of([rng.uniform(low, high) for low, high in box]) for _ in range(poses)]
    _round_trip("anywhere inside the limits of send_coords", anywhere, rng, limited=False)


def _round_trip(what: str, poses: list[Pose], rng: random.Random, *, limited: bool) -> None:
    ways, turns, outside = [], [], 0
    started = time.perf_counter()
    for pose in poses:
        found = nearest(MYCOBOT_280, pose, random_angles(rng), LIMITS)
        if found is not None:
            way, turn = flange(MYCOBOT_280, found).distance(pose)
            ways.append(way)
            turns.append(turn)
            outside += not within_limits(found)
    each = (time.perf_counter() - started) / len(poses)
    print(
        f"{len(poses)} poses {what}: {len(ways)} reachable, at most {max(ways):.2g} mm and "
        f"{max(turns):.2g} degrees off; {outside} outside the limits; {each * 1e6:.0f} us each"
    )
    if limited:
        right = len(ways) == len(poses) and not outside
        right = right and max(ways) <= MILLIMETRES and max(turns) <= DEGREES
        print(f"  {'within' if right else 'OVER'} {MILLIMETRES} mm and {DEGREES} degrees")


if __name__ == "__main__":
    main()
