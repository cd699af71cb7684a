"""A stall of one processor, or of pseudo-terminals alone, is measured."""

from __future__ import annotations

import os
import subprocess
import sys
import termios
import time

import pytest

from machine_stalls import ProcessorMeter, PtyMeter, machine_stalls

PERIOD, SECONDS = 0.02, 0.5
# Occupies one processor with the highest priority, for as long as a host would stall it.
OCCUPY = """
import os, sys, time
os.sched_setaffinity(0, {int(sys.argv[1])})
os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
end = time.monotonic() + float(sys.argv[2])
while time.monotonic() < end:
    pass
"""


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="the system moves no threads")
def test_stall_of_one_processor_is_measured() -> None:
    processors = sorted(os.sched_getaffinity(0))
    if len(processors) == 1:
        pytest.skip("there is one processor")
    for processor in processors:
        command = [sys.executable, "-c", OCCUPY, str(processor), str(SECONDS)]
        with ProcessorMeter(PERIOD) as meter:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        if "PermissionError" in done.stderr:
            pytest.skip("only root may occupy a processor")
        assert done.returncode == 0, done.stderr
        assert meter.worst_second > SECONDS / 2
    assert os.sched_getaffinity(0) == set(processors), "this thread was moved"


def test_stall_of_pseudo_terminals_is_measured() -> None:
    with machine_stalls(PERIOD) as stalls:
        [meter] = [each for each in stalls.meters if isinstance(each, PtyMeter)]
        termios.tcflow(meter.slave, termios.TCOOFF)
        time.sleep(SECONDS)
        termios.tcflow(meter.slave, termios.TCOON)
    assert stalls.worst_second > SECONDS / 2
