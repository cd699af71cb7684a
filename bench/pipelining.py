"""Measure the gain of two outstanding requests, with bare frames over a pty and two kinds of arm.

One arm handles requests one after another, 8 ms each: a loop that reads a frame, queries the servos
and replies. The other replies to each request 8 ms after its arrival, like a slow line. The bench
sends get_angles and get_coords one after another, as the session does, and then both at once.
"""

from __future__ import annotations

import os
import select
import statistics
import time

from responder import responder

ROUNDS = 100
REQUESTS = [bytes.fromhex("FE FE 02 20 FA"), bytes.fromhex("FE FE 02 23 FA")]
REPLY_SIZE = 17
# Reads all requests; replies to each 8 ms after its arrival, or 8 ms after the previous reply.
RESPONDER = """
import os, select, sys, time
master, one_by_one = int(sys.argv[1]), sys.argv[2] == "one after another"
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
    """Measure, and print the time of two requests in turns and at once."""
    for kind in ("one after another", "independently"):
        with responder(RESPONDER, kind) as url:
            descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)
            one_by_one = statistics.median(_round(descriptor, REQUESTS) for _ in range(ROUNDS))
            both = [b"".join(REQUESTS)]
            at_once = statistics.median(_round(descriptor, both) for _ in range(ROUNDS))
            os.close(descriptor)
        print(
            f"two requests, an arm that replies {kind:17} in turns {one_by_one * 1e3:5.1f} ms, "
            f"at once {at_once * 1e3:5.1f} ms: {one_by_one / at_once:.2f} x"
        )


def _round(descriptor: int, writes: list[bytes]) -> float:
    """Make each write and read its replies before the next; return the seconds."""
    started = time.perf_counter()
    for data in writes:
        os.write(descriptor, data)
        wanted = REPLY_SIZE * data.count(b"\xfa")
        while wanted > 0:
            if not select.select([descriptor], [], [], 2.0)[0]:
                raise SystemExit("the responder sent no reply")
            wanted -= len(os.read(descriptor, 4096))
    return time.perf_counter() - started


if __name__ == "__main__":
    main()
