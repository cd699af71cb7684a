"""Compare our classes with the maker's, and with what they are rewritten to: ``make layer``.

Compared are calls on simulated arms, drawn arguments, replies, calls over TCP, and the calls that
``cobotwire migrate`` rewrites.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO

from cobotwire.pymycobot.migrate.calls import library
from differences import unruled
from layer_comparison import Compared, compare
from layer_replies import compare_replies
from layer_robots import ALL_ROBOTS, SOCKETS
from layer_sockets import compare_sockets
from layer_values import compare_values
from migrated_calls import compare_migrated

COMPARISONS: dict[str, Callable[..., Compared]] = {
    "calls": compare,
    "values": compare_values,
    "replies": compare_replies,
}


def main(arguments: list[str]) -> int:
    """Print what each comparison of each class found; return 1 if a ruling lacks or is stale.

    With names of classes, compare these only.
    """
    left = 0
    print(f"{'class':22}{'':10}{'compared':>9}{'methods':>9}{'ruled':>7}{'open':>6}{'seconds':>9}")
    for name in arguments or ALL_ROBOTS:
        for part, comparison in COMPARISONS.items():
            start = time.perf_counter()
            # The maker's classes print the errors of a robot.
            with redirect_stdout(StringIO()):
                compared = comparison(ALL_ROBOTS[name])
            lacking = unruled(name, compared.found, compared.methods, part)
            left += _shown(name, part, compared, lacking, start)
        if name in SOCKETS:
            start = time.perf_counter()
            with redirect_stdout(StringIO()):
                compared = compare_sockets(ALL_ROBOTS[name])
            lacking = unruled(name, compared.found, (), "calls")
            left += _shown(name, "tcp", compared, lacking, start)
    for name in [each for each in arguments or sorted(library()) if each in library()]:
        with redirect_stdout(StringIO()):
            equal, listed, wrong = compare_migrated(name)
        print(f"{name:22}rewritten {equal:9} equal, {listed} to decide", flush=True)
        for text in wrong:
            print(f"OPEN: {text}", flush=True)
        left += len(wrong)
    return 1 if left else 0


def _shown(name: str, part: str, compared: Compared, lacking: list[str], start: float) -> int:
    ruled, seconds = len(compared.found) - len(lacking), time.perf_counter() - start
    counts = (
        f"{compared.compared:9}{len(compared.methods):9}{ruled:7}{len(lacking):6}{seconds:9.1f}"
    )
    print(f"{name:22}{part:10}{counts}", flush=True)
    for text in lacking:
        print(f"OPEN: {text}", flush=True)
    return len(lacking)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
