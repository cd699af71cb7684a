"""Measure for how long single threads and processors were stopped, on Linux.

A :class:`stalls.StallMeter` measures stops of the whole process. The system may also stop one
thread, and the host of a virtual machine one processor, while all others run.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

PERIOD = 0.03
# Shorter stops are usual on a busy machine.
SHORTEST = 0.02
# /proc/stat counts hundredths of a second; the eighth number is the time taken by the host.
TICK, STOLEN = 0.01, 8
SYSTEM, PROCESSORS = Path("/proc"), Path("/proc/stat")


class MachineMeter:
    """A thread that measures while the ``with`` block runs.

    Attributes:
        stops: for each thread and each processor: when it had been stopped, and for how many
            seconds.
        processes: the processes whose threads are measured.
    """

    def __init__(self) -> None:
        self.processes = ["self"]
        self.stops: dict[str, list[tuple[float, float]]] = {}
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._measure, daemon=True)

    def __enter__(self) -> MachineMeter:
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._over.set()
        self._thread.join()

    def _measure(self) -> None:
        before = _stopped(self.processes)
        while not self._over.wait(PERIOD):
            after = _stopped(self.processes)
            now = time.monotonic()
            for name, seconds in after.items():
                stopped = seconds - before.get(name, seconds)
                if stopped >= SHORTEST:
                    self.stops.setdefault(name, []).append((now, stopped))
            before = after


def _stopped(processes: Sequence[str]) -> dict[str, float]:
    """Return for how many seconds each thread and processor has been stopped so far."""
    found = {}
    with suppress(OSError):
        for line in PROCESSORS.read_text().splitlines():
            name, *numbers = line.split()
            if name.startswith("cpu") and name != "cpu":
                found[name] = int(numbers[STOLEN - 1]) * TICK
    for process in processes:
        with suppress(OSError):
            for thread in (SYSTEM / process / "task").iterdir():
                with suppress(OSError):
                    # Nanoseconds that it ran, and that it waited for a processor.
                    found[thread.name] = int((thread / "schedstat").read_text().split()[1]) / 1e9
    return found
