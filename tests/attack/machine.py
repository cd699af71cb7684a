"""Measure how long the machine kept a single thread, processor or pty from working, on Linux.

A :class:`stalls.StallMeter` sees what stops the whole process. The system may also stop one thread,
and the host of a virtual machine one processor, while all others run. A thread of the system passes
the bytes of all ptys on, and it may be stopped as well.
"""

from __future__ import annotations

import os
import threading
import time
import tty
from contextlib import suppress
from pathlib import Path

PERIOD = 0.03
# Shorter stops are as usual on a busy machine.
SHORTEST = 0.02
# /proc/stat counts hundredths of a second; the eighth number is the time taken by the host.
TICK, STOLEN = 0.01, 8
THREADS, PROCESSORS = Path("/proc/self/task"), Path("/proc/stat")


class MachineMeter:
    """Threads that measure while the ``with`` block runs.

    Attributes:
        stops: for each thread, for each processor and for a pty: when it had been stopped, and for
            how many seconds.
    """

    def __init__(self) -> None:
        self.stops: dict[str, list[tuple[float, float]]] = {}
        self._over = threading.Event()
        work = (self._measure_threads, self._measure_pty)
        self._threads = [threading.Thread(target=each, daemon=True) for each in work]

    def __enter__(self) -> MachineMeter:
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._over.set()
        for thread in self._threads:
            thread.join()

    def _measure_threads(self) -> None:
        before = _stopped()
        while not self._over.wait(PERIOD):
            after = _stopped()
            now = time.monotonic()
            for name, seconds in after.items():
                self._note(name, now, seconds - before.get(name, seconds))
            before = after

    def _measure_pty(self) -> None:
        master, slave = os.openpty()
        tty.setraw(slave)
        while not self._over.wait(PERIOD):
            before = time.monotonic()
            os.write(slave, b"x")
            os.read(master, 1)
            now = time.monotonic()
            self._note("pty", now, now - before)
        os.close(master)
        os.close(slave)

    def _note(self, name: str, now: float, seconds: float) -> None:
        if seconds >= SHORTEST:
            self.stops.setdefault(name, []).append((now, seconds))


def _stopped() -> dict[str, float]:
    """Return for how many seconds each thread and processor has been stopped so far."""
    found = {}
    with suppress(OSError):
        for line in PROCESSORS.read_text().splitlines():
            name, *numbers = line.split()
            if name.startswith("cpu") and name != "cpu":
                found[name] = int(numbers[STOLEN - 1]) * TICK
    with suppress(OSError):
        for thread in THREADS.iterdir():
            with suppress(OSError):
                # Nanoseconds that it ran, and that it waited for a processor.
                found[thread.name] = int((thread / "schedstat").read_text().split()[1]) / 1e9
    return found
