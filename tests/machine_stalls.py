"""Measure stalls of single processors and of pseudo-terminals, which do not delay other threads."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import cycle
from typing import Self

from stalls import PERIOD, StallMeter

try:
    import tty
except ModuleNotFoundError:  # Windows
    tty = None  # type: ignore[assignment]


class ProcessorMeter(StallMeter):
    """A meter that visits all processors of the process in turn, where the system allows that.

    The host of a virtual machine may stop one processor; threads on the others do not notice.
    """

    def __init__(self, period: float = PERIOD) -> None:
        """Measure every ``period`` seconds."""
        super().__init__(period)
        allowed = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()
        self._processors = cycle(sorted(allowed)) if len(allowed) > 1 else None

    def _visit(self) -> None:
        if self._processors is not None:
            # Only this thread moves. The call returns once it runs there.
            os.sched_setaffinity(0, {next(self._processors)})


class PtyMeter(StallMeter):
    """A meter that sends a byte through a pseudo-terminal.

    A thread of the system forwards the bytes of all pseudo-terminals; it may be late by itself.

    Attributes:
        slave: the descriptor of the end that it writes to.
    """

    def __enter__(self) -> Self:
        """Open a pseudo-terminal, and start to measure."""
        self._master, self.slave = os.openpty()
        tty.setraw(self.slave)
        return super().__enter__()

    def __exit__(self, *raised: object) -> None:
        """End the thread, and close the pseudo-terminal."""
        super().__exit__(*raised)
        os.close(self._master)
        os.close(self.slave)

    def _visit(self) -> None:
        os.write(self.slave, b"x")
        os.read(self._master, 1)


class MachineStalls:
    """The meters of the machine that a run used.

    Attributes:
        meters: one meter for the processors, and one for pseudo-terminals if the system has them.
    """

    def __init__(self, period: float) -> None:
        """Measure every ``period`` seconds."""
        self.meters: list[StallMeter] = [ProcessorMeter(period)]
        if tty is not None:
            self.meters.append(PtyMeter(period))

    def restart(self) -> None:
        """Forget the delays so far."""
        for meter in self.meters:
            meter.restart()

    def include_current(self) -> None:
        """Count the delays that have not ended yet."""
        for meter in self.meters:
            meter.include_current()

    @property
    def worst_second(self) -> float:
        """The most that the delays of one meter add up to within a second, in seconds."""
        return max(meter.worst_second for meter in self.meters)


@contextmanager
def machine_stalls(period: float) -> Iterator[MachineStalls]:
    """Measure while the ``with`` block runs."""
    stalls = MachineStalls(period)
    with ExitStack() as running:
        for meter in stalls.meters:
            running.enter_context(meter)
        yield stalls
