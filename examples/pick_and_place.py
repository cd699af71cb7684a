"""Pick up a part at one place, and put it down at another: pick_and_place.py PORT."""

import sys
import time

from cobotwire import MyCobot280
from cobotwire.editions.mycobot280 import Coords, MoveMode

SPEED = 60  # percent
# The gripper points down: x, y, z in millimetres, rx, ry, rz in degrees.
PICK = Coords(218, -65, 90, -180, 0, -90)
PLACE = Coords(174, 168, 90, -180, 0, -30)
CLEARANCE = 60  # millimetres above the part, so that nothing is hit between the places
OPEN, CLOSED = 100, 30  # percent of the gripper's opening
# A bent arm; from here both places are in reach without turning the wrist over.
READY = [0, -30, -60, 0, 0, 0]


def main(port: str) -> None:
    """Move one part. If anything fails, the client stops the arm before the error is printed."""
    with MyCobot280(port) as arm:
        arm.power_on()
        grip(arm, OPEN)
        arm.move_angles(READY, SPEED)
        visit(arm, PICK, CLOSED)
        visit(arm, PLACE, OPEN)
        arm.move_angles(READY, SPEED)
        print("placed the part at", arm.get_coords())


def visit(arm: MyCobot280, place: Coords, opening: int) -> None:
    """Go above a place, straight down to it, set the gripper, and go straight up again."""
    above = place._replace(z=place.z + CLEARANCE)
    arm.move_coords(above, SPEED, MoveMode.ANGULAR)
    arm.move_coords(place, SPEED // 2, MoveMode.LINEAR)
    grip(arm, opening)
    print("gripper at", arm.get_gripper_value(), "percent")
    arm.move_coords(above, SPEED // 2, MoveMode.LINEAR)


def grip(arm: MyCobot280, opening: int) -> None:
    """Set the gripper, and wait until it stops; it stops early if it holds a part."""
    arm.set_gripper_value(opening, SPEED)
    while arm.is_gripper_moving():
        time.sleep(0.05)


if __name__ == "__main__":
    main(sys.argv[1])
