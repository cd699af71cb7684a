"""Measure the time of a call over a pty, with a trivial responder in another process.

The floor is the time of bare system calls for the same bytes: os.write, select, os.read. All
candidates take turns on the same responder in one run. The fastest turn of each counts, since other
programs on the machine can only add time. The limits apply to the ratios.

The simulated arm replies on its own pty to the same bare system calls; its row shows how much
longer it takes than the trivial responder.

A pty has no baud rate. So the setters are compared with the fastest real line (ten bits a byte at
1,000,000 baud), and with bare os.write of the same frames.
"""

from __future__ import annotations

import asyncio
import os
import select
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.pymycobot import MyCobot280 as Layer
from responder import responder, within

REQUEST = bytes.fromhex("FE FE 02 20 FA")
REPLY = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
RESPONDER = f"""
import os, sys
master = int(sys.argv[1])
while data := os.read(master, 4096):
    if data[3] == 0x20:
        os.write(master, {REPLY!r})
"""
SIMULATED = """
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
port = PtyServer(SimulatedArm(TABLE))
print(port.url, flush=True)
port.serve()
"""
TURNS, CALLS, WARM_UP = 20, 50, 5
SETTERS = 1000
FASTEST_BAUD = 1_000_000
LIMITS = {"blocking": 1.35, "asyncio": 3.0, "simulated arm": 3.0}
TIMES_FASTER = 5.0
# The layer with the maker's names against the client that it calls.
LAYER_LIMIT = 1.3


def main() -> None:
    """Measure, and print the ratios with their limits."""
    with responder(RESPONDER) as url, _simulated() as simulated:
        _round_trips(url, simulated)
    with responder(RESPONDER) as url:
        _setters(url)


@contextmanager
def _simulated() -> Iterator[str]:
    command = [sys.executable, "-c", SIMULATED]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as arm:
        assert arm.stdout is not None
        try:
            yield arm.stdout.readline().strip()
        finally:
            arm.kill()


def _round_trips(url: str, simulated: str) -> None:
    """Time each candidate. It opens the port for its turn, untimed, since open ports are locked."""
    candidates = {
        "floor": _floor,
        "simulated arm": lambda _: _floor(simulated),
        "blocking": _blocking,
        "blocking, of the 280": _of_the_280,
        "blocking, layer": _layer,
        "asyncio": lambda port: asyncio.run(_asyncio(port)),
        "pymycobot": _pymycobot,
    }
    taken: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(TURNS):
        for name, turn in candidates.items():
            taken[name].append(turn(url) / CALLS)
    best = {name: min(times) for name, times in taken.items()}
    for name, seconds in best.items():
        ratio = seconds / best["floor"]
        limit = LIMITS.get(name)
        verdict = "" if limit is None else f"   {within(ratio <= limit)} {limit:g} x"
        print(f"get_angles, {name:22} {seconds * 1e6:6.0f} us   {ratio:5.1f} x floor{verdict}")
    faster = best["pymycobot"] / best["blocking"]
    verdict = within(faster >= TIMES_FASTER)
    name = "blocking, against pymycobot"
    print(f"{name:34} {faster:5.1f} x faster   {verdict} {TIMES_FASTER:.0f} x")
    share = best["blocking, layer"] / best["blocking, of the 280"]
    verdict = within(share <= LAYER_LIMIT)
    print(f"{'layer, against its client':34} {share:5.2f} x   {verdict} {LAYER_LIMIT} x")


def _timed(call: Callable[[], Any]) -> float:
    for _ in range(WARM_UP):
        call()
    started = time.perf_counter()
    for _ in range(CALLS):
        call()
    return time.perf_counter() - started


def _floor(url: str) -> float:
    descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)

    def call() -> None:
        os.write(descriptor, REQUEST)
        select.select([descriptor], [], [], 1.0)
        if len(os.read(descriptor, 4096)) != len(REPLY):
            raise SystemExit("the reply came in parts; run the bench again on a quiet machine")

    try:
        return _timed(call)
    finally:
        os.close(descriptor)


def _blocking(url: str) -> float:
    with MyCobot(url) as arm:
        return _timed(arm.get_angles)


def _of_the_280(url: str) -> float:
    with MyCobot280(url) as arm:
        return _timed(arm.get_angles)


def _layer(url: str) -> float:
    arm = Layer(url, "115200")
    try:
        return _timed(arm.get_angles)
    finally:
        arm.close()


async def _asyncio(url: str) -> float:
    async with AsyncMyCobot(url) as arm:
        for _ in range(WARM_UP):
            await arm.get_angles()
        started = time.perf_counter()
        for _ in range(CALLS):
            await arm.get_angles()
        return time.perf_counter() - started


def _pymycobot(url: str) -> float:
    from pymycobot import MyCobot280 as Theirs

    arm = Theirs(url, "115200")
    try:
        return _timed(arm.get_angles)
    finally:
        arm._serial_port.close()


def _setters(url: str) -> None:
    """Time one-way setters; the responder reads them and sends nothing."""
    size = 0

    def setters(arm: MyCobot) -> float:
        started = time.perf_counter()
        for index in range(SETTERS):
            arm.set_color(index % 256, 2, 3)
        return time.perf_counter() - started

    with MyCobot(url) as arm:
        frames: list[bytes] = []
        end = arm.add_traffic_listener(lambda traffic: frames.append(traffic.data))
        arm.set_color(1, 2, 3)
        end()
        size = SETTERS * len(frames[0])
        ours = min(setters(arm) for _ in range(5))
    descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)
    started = time.perf_counter()
    for _ in range(SETTERS):
        os.write(descriptor, frames[0])
    bare = time.perf_counter() - started
    os.close(descriptor)
    line = size * 10 / FASTEST_BAUD
    print(
        f"{SETTERS} one-way setters    {ours * 1e3:8.1f} ms   {ours / line:5.1f} x the line's "
        f"{line * 1e3:.0f} ms at 1 Mbaud   {within(ours <= 2 * line)} 2 x   "
        f"({ours / bare:.1f} x bare os.write)"
    )


if __name__ == "__main__":
    main()
