"""How fast a call is: over a pty, against a trivial responder in a process of its own.

The floor is what the machine needs for the same bytes: os.write, select, os.read. All candidates
take turns on one and the same responder in one run, and what counts is the ratio of their medians.
"""

from __future__ import annotations

import os
import select
import statistics
import subprocess
import sys
import time
import tty
from collections.abc import Callable
from typing import Any

from cobotwire.editions.mycobot import MyCobot

QUESTION = bytes.fromhex("FE FE 02 20 FA")
ANSWER = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
RESPONDER = f"""
import os, sys
master = int(sys.argv[1])
while data := os.read(master, 4096):
    if data[3] == 0x20:
        os.write(master, {ANSWER!r})
"""
ROUNDS, CALLS = 30, 100


def main() -> None:
    """Measure, and print ratios beside the limits."""
    master, slave = os.openpty()
    tty.setraw(slave)
    command = [sys.executable, "-c", RESPONDER, str(master)]
    with subprocess.Popen(command, pass_fds=[master]) as responder:  # noqa: S603  (our own)
        try:
            _round_trips(os.ttyname(slave))
        finally:
            responder.kill()


def _round_trips(url: str) -> None:
    with MyCobot(url) as arm:
        candidates: dict[str, Callable[[], Any]] = {
            "floor": _floor(arm._link._port.fd),  # type: ignore[attr-defined]
            "blocking": arm.get_angles,
        }
        times: dict[str, list[float]] = {name: [] for name in candidates}
        for _ in range(ROUNDS):
            for name, call in candidates.items():
                started = time.perf_counter()
                for _ in range(CALLS):
                    call()
                times[name].append((time.perf_counter() - started) / CALLS)
    for name, taken in times.items():
        print(name, statistics.median(taken) * 1e6)


def _floor(descriptor: int) -> Callable[[], bytes]:
    def call() -> bytes:
        os.write(descriptor, QUESTION)
        select.select([descriptor], [], [], 1.0)
        return os.read(descriptor, 4096)

    return call


if __name__ == "__main__":
    main()
