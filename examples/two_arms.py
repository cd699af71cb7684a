"""Move two arms in step, with asyncio: two_arms.py PORT PORT."""

import asyncio
import sys

from cobotwire import AsyncMyCobot280

SPEED = 60  # percent
# The poses of the left arm; the right one mirrors them.
POSES = [[40, -20, 30, 0, 0, 0], [-40, -20, 30, 0, 0, 0], [0, 0, 0, 0, 0, 0]]


async def main(left: str, right: str) -> None:
    """Run both arms. If one fails, the other is stopped too."""
    both_there = asyncio.Barrier(2)
    async with asyncio.TaskGroup() as group:
        group.create_task(run(left, both_there, mirror=1))
        group.create_task(run(right, both_there, mirror=-1))
    print("both arms are back")


async def run(port: str, both_there: asyncio.Barrier, mirror: int) -> None:
    """Move one arm through the poses; before each one, wait for the other arm."""
    # The task group cancels the other task if one fails; its client then sends stop.
    async with AsyncMyCobot280(port) as arm:
        await arm.power_on()
        for j1, *others in POSES:
            await both_there.wait()
            await arm.move_angles([mirror * j1, *others], SPEED)
            print(port, "is at", (await arm.get_angles()).j1)


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
