"""A device as a program: ``device_program.py HOW [LIMIT]``.

HOW is ``stdio``, or the path of a pseudo-terminal. After LIMIT requests it ends with an error.
"""

from __future__ import annotations

import os
import select
import sys

from cobotwire import editions
from cobotwire.simulator import SimulatedArm


def main(how: str, limit: int = 0) -> None:
    """Reply until the line is closed."""
    arm = SimulatedArm(editions.load("mycobot280").TABLE)
    reads, writes = (0, 1) if how == "stdio" else (os.open(how, os.O_RDWR | os.O_NOCTTY),) * 2
    requests = 0
    while True:
        ready = select.select([reads], [], [], arm.wait)[0]
        data = os.read(reads, 4096) if ready else b""
        if ready and not data:
            return
        os.write(writes, arm.receive(data) if data else arm.flush())
        requests += bool(data)
        if requests == limit:
            sys.exit("the motor driver is on fire")


main(sys.argv[1], *map(int, sys.argv[2:]))
