"""Would it pay to have two questions outstanding? Bare frames over a pty, two kinds of arm.

One arm does the two things after each other, 8 ms each: a loop that reads a frame, asks the servos
and answers. The other answers each question 8 ms after it came: a line that is merely long. What is
measured is get_angles and get_coords, one after the other as the session asks them, and at once.
"""

from __future__ import annotations

import os
import select
import statistics
import subprocess
import sys
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager

ROUNDS = 100
QUESTIONS = [bytes.fromhex("FE FE 02 20 FA"), bytes.fromhex("FE FE 02 23 FA")]
ANSWER_SIZE = 17
# Takes all requests that came, and answers each 8 ms after it came, or after the one before.
RESPONDER = """
import os, select, sys, time
master, one_by_one = int(sys.argv[1]), sys.argv[2] == "after each other"
due = []
while True:
    left = max(0.0, due[0][0] - time.monotonic()) if due else None
    if select.select([master], [], [], left)[0]:
        for request in os.read(master, 4096).split(b"\\xfa")[:-1]:
            free = due[-1][0] if due and one_by_one else 0.0
            due.append((max(time.monotonic(), free) + 0.008, request[3]))
    while due and due[0][0] <= time.monotonic():
        os.write(master, bytes((254, 254, 14, due.pop(0)[1])) + bytes(12) + b"\\xfa")
"""


def main() -> None:
    """Measure, and print what both ways take."""
    for kind in ("after each other", "each by itself"):
        with _responder(kind) as descriptor:
            one_by_one = statistics.median(_round(descriptor, QUESTIONS) for _ in range(ROUNDS))
            both = [b"".join(QUESTIONS)]
            at_once = statistics.median(_round(descriptor, both) for _ in range(ROUNDS))
        print(
            f"two questions, an arm that answers {kind:17} in turns {one_by_one * 1e3:5.1f} ms, "
            f"at once {at_once * 1e3:5.1f} ms: {one_by_one / at_once:.2f} x"
        )


@contextmanager
def _responder(kind: str) -> Iterator[int]:
    master, slave = os.openpty()
    tty.setraw(slave)
    command = [sys.executable, "-c", RESPONDER, str(master), kind]
    with subprocess.Popen(command, pass_fds=[master]) as responder:  # noqa: S603  (our own)
        try:
            yield slave
        finally:
            responder.kill()
            os.close(master)
            os.close(slave)


def _round(descriptor: int, writes: list[bytes]) -> float:
    """Write each, and read all answers to it before the next; gives the seconds."""
    started = time.perf_counter()
    for data in writes:
        os.write(descriptor, data)
        wanted = ANSWER_SIZE * data.count(b"\xfa")
        while wanted > 0:
            if not select.select([descriptor], [], [], 2.0)[0]:
                raise SystemExit("the responder does not answer")
            wanted -= len(os.read(descriptor, 4096))
    return time.perf_counter() - started


if __name__ == "__main__":
    main()
