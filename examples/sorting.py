"""Sort parts into two boxes by their weight: sorting.py PORT GRAMS.

test_sorting.py tests this program without an arm.
"""

import sys

from cobotwire import MyCobot280

SPEED = 50  # percent
HOME = [0, 0, 0, 0, 0, 0]
# Degrees; above each box.
LIGHT = [60, -20, -40, 0, 0, 0]
HEAVY = [-60, -20, -40, 0, 0, 0]
LIMIT = 100  # grams
MOST = 250  # grams that the arm can carry
OPENING_SECONDS = 2.0


def main(port: str, grams: float) -> None:
    """Sort one part, and return home."""
    with MyCobot280(port) as arm:
        arm.power_on()
        print("put into the", drop(arm, grams), "box")
        arm.move_angles(HOME, SPEED)


def drop(arm: MyCobot280, grams: float) -> str:
    """Drop the part that the gripper holds into its box; return the name of the box.

    Raises:
        ValueError: the part is too heavy; the arm has not moved.
    """
    if grams > MOST:
        raise ValueError(f"the part weighs {grams:g} g; the arm carries {MOST} g")
    box = "light" if grams <= LIMIT else "heavy"
    arm.move_angles(LIGHT if box == "light" else HEAVY, SPEED)
    arm.set_gripper_value(100, SPEED)
    arm.listen(OPENING_SECONDS)
    return box


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
