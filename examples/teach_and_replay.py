"""Lead the arm by hand, then let it repeat the path: teach_and_replay.py PORT [SECONDS]."""

import sys
from collections.abc import Sequence

from cobotwire import MyCobot280
from cobotwire.editions.mycobot280 import Angles, GetAngles

RATE = 20  # samples a second
STEP = 5.0  # degrees; a pose that is nearer to the one before is not kept
SPEED = 50  # percent


def main(port: str, seconds: float = 10.0) -> list[Angles]:
    """Teach for some seconds, then replay. Return the path."""
    with MyCobot280(port) as arm:
        # The arm has no brakes: hold it before its servos let go.
        arm.release_all_servos()
        path = teach(arm, seconds)
        print("recorded", len(path), "poses")
        arm.power_on()  # hold the arm where it is now
        for pose in path:
            arm.move_angles(pose, SPEED)
        print("replayed; the arm is at", arm.get_angles())
    return path


def teach(arm: MyCobot280, seconds: float) -> list[Angles]:
    """Sample the angles for some seconds; return the poses that differ, and the last one."""
    path: list[Angles] = []
    with arm.stream(GetAngles(), rate=RATE) as stream:
        for sample in stream:
            angles = sample[GetAngles()]
            last = sample.period >= seconds * RATE
            if last or not path or distance(angles, path[-1]) >= STEP:
                path.append(angles)
            if last:
                return path
    return path


def distance(one: Sequence[float], other: Sequence[float]) -> float:
    """Return the largest angle between two poses, in degrees."""
    return max(abs(a - b) for a, b in zip(one, other))


if __name__ == "__main__":
    main(sys.argv[1], *map(float, sys.argv[2:]))
