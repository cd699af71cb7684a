"""Poll 500 arms at 20 Hz in one process, then 1,000: lateness, CPU time and memory.

The arms are TCP connections to the process of `asyncio_calls.py`, which compares a call with bare
asyncio. The lateness of a sample is the time from the beginning of its period until the consumer
has it. On Linux, the client and the arms run on one core each. The CPU time is measured in the
client's process. Memory is the growth of the process for each open arm with a stream, and the
allocations of Python for it (tracemalloc, measured with few arms).
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import resource
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from asyncio_calls import ARMS
from cobotwire.client.aio_streaming import AsyncStream
from cobotwire.editions.mycobot280 import AsyncMyCobot280, GetAngles
from responder import within

# How many arms connect at the same time.
TOGETHER = 50
# Seconds before the first measured sample.
WARM_UP = 2.0
# The streams start one after another, during this many periods. Streams that start together stay
# together, and each is late by the time that the others take.
START_PERIODS = 20
TRACED_ARMS = 50
# The limits hold for this many arms.
LIMITED_ARMS = 500
LATE_SECONDS = 0.020
CPU_SECONDS = 50e-6
ARM_BYTES = 100 << 10


class Result(NamedTuple):
    """What a run has measured; times in seconds, sizes in bytes."""

    lateness: list[float]
    missed: int
    cpu_per_sample: float
    cpu_share: float
    resident: float


def main() -> None:
    """Measure and print; exit with 1 if a limit was missed and --strict is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--arms", type=int, nargs="+", default=[500, 1000])
    parser.add_argument("--rate", type=float, default=20.0)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument(
        "--rare-collections",
        action="store_true",
        help="collect garbage rarely, as docs/guide/fleet.md shows",
    )
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a limit is missed")
    options = parser.parse_args()
    # Each arm needs a descriptor here, and one in the other process.
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    met = True
    with _arms() as url:
        for count in options.arms:
            rate, rarely = options.rate, options.rare_collections
            result = asyncio.run(_run(url, count, rate, options.seconds, rarely))
            # With more arms than that, samples may be late.
            met &= _show(result, count, rate) or count > LIMITED_ARMS
        traced = asyncio.run(_traced(url))
    print(f"Python's objects take {traced / 1024:.0f} KiB an arm")
    sys.exit(1 if options.strict and not met else 0)


def _show(result: Result, count: int, rate: float) -> bool:
    late = sorted(result.lateness)
    p99, cpu, resident = late[len(late) * 99 // 100], result.cpu_per_sample, result.resident
    print(
        f"{count} arms at {rate:g} Hz: {len(late)} samples, {result.missed} periods missed\n"
        f"  late by {late[len(late) // 2] * 1e3:.1f} ms (median), {p99 * 1e3:.1f} ms (99 %), "
        f"{late[-1] * 1e3:.0f} ms (most)   {within(p99 <= LATE_SECONDS)} "
        f"{LATE_SECONDS * 1e3:.0f} ms at 99 %\n"
        f"  {cpu * 1e6:.0f} us of CPU a sample   {within(cpu <= CPU_SECONDS)} "
        f"{CPU_SECONDS * 1e6:.0f} us; {result.cpu_share:.0%} of a core\n"
        f"  {resident / 1024:.0f} KiB resident an arm   {within(resident <= ARM_BYTES)} "
        f"{ARM_BYTES >> 10} KiB"
    )
    return p99 <= LATE_SECONDS and cpu <= CPU_SECONDS and resident <= ARM_BYTES


@contextmanager
def _arms() -> Iterator[str]:
    with subprocess.Popen(
        [sys.executable, "-c", ARMS], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        _keep_apart(process.pid)
        try:
            yield f"socket://127.0.0.1:{int(process.stdout.readline())}"
        finally:
            process.kill()


def _keep_apart(arms: int) -> None:
    """Give the process of the arms a core, and this one another, where the system allows it."""
    if not hasattr(os, "sched_setaffinity"):
        return
    cores = sorted(os.sched_getaffinity(0))
    if len(cores) > 1:
        os.sched_setaffinity(arms, cores[:1])
        os.sched_setaffinity(0, cores[-1:])


async def _run(url: str, count: int, rate: float, seconds: float, rarely: bool) -> Result:
    # What all arms share is loaded before the first measured arm.
    await _closed(await _opened(url, 1))
    gc.collect()
    before = _resident()
    arms = await _opened(url, count)
    if rarely:
        gc.freeze()
        gc.set_threshold(50_000, 20, 100)
    streams = [arm.stream(GetAngles(), rate=rate) for arm in arms]
    lateness: list[float] = []
    begin = time.monotonic() + WARM_UP + 1 / rate
    polls = [
        # The arms take turns within a period, so that their replies do not come all at once.
        asyncio.create_task(_poll(stream, rate, delay, begin, seconds, lateness))
        for stream, delay in zip(streams, _delays(count, rate))
    ]
    await asyncio.sleep(begin - time.monotonic())
    started, cpu = time.monotonic(), time.process_time()
    missed = sum(stream.report.periods - stream.report.samples for stream in streams)
    await asyncio.gather(*polls)
    spent, cpu = time.monotonic() - started, time.process_time() - cpu
    missed = sum(stream.report.periods - stream.report.samples for stream in streams) - missed
    resident = (_resident() - before) / count
    await _closed(arms)
    return Result(lateness, missed, cpu / max(1, len(lateness)), cpu / spent, resident)


def _delays(count: int, rate: float) -> list[float]:
    return [(index / count + index % START_PERIODS) / rate for index in range(count)]


async def _poll(
    stream: AsyncStream, rate: float, delay: float, begin: float, seconds: float, late: list[float]
) -> None:
    await asyncio.sleep(delay)
    first = time.monotonic()
    async for sample in stream:
        now = time.monotonic()
        if now >= begin + seconds:
            break
        if now >= begin:
            late.append(now - first - sample.period / rate)
    stream.close()


async def _traced(url: str) -> float:
    """Return the bytes that Python allocates for an arm with a stream that has one sample."""
    await _closed(await _opened(url, 1))
    gc.collect()
    tracemalloc.start()
    try:
        arms = await _opened(url, TRACED_ARMS)
        streams = [arm.stream(GetAngles(), rate=20.0) for arm in arms]
        samples = [await anext(stream) for stream in streams]
        gc.collect()
        size, _ = tracemalloc.get_traced_memory()
        del samples
    finally:
        tracemalloc.stop()
    await _closed(arms)
    return size / TRACED_ARMS


async def _opened(url: str, count: int) -> list[AsyncMyCobot280]:
    arms = [AsyncMyCobot280(url) for _ in range(count)]
    for start in range(0, count, TOGETHER):
        await asyncio.gather(*(arm.open() for arm in arms[start : start + TOGETHER]))
    return arms


async def _closed(arms: list[AsyncMyCobot280]) -> None:
    for arm in arms:
        await arm.close()


def _resident() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


if __name__ == "__main__":
    main()
