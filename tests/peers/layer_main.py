"""Compare our classes with the maker's, and rewritten calls with the originals: ``make layer``.

It compares calls on simulated arms, drawn arguments, replies, and the calls that ``cobotwire
migrate`` rewrites.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from io import StringIO

from cobotwire.pymycobot.migrate.calls import library
from differences import Difference, stale, unruled, unused
from layer_comparison import Compared, compare
from layer_replies import compare_replies
from layer_robots import ALL_ROBOTS
from layer_values import compare_values
from migrated_calls import compare_migrated

COMPARISONS: dict[str, Callable[..., Compared]] = {
    "calls": compare,
    "values": compare_values,
    "replies": compare_replies,
}


def main(names: list[str]) -> int:
    """Print what each comparison of each class found; return 1 if a ruling is missing or stale.

    With names of classes, compare these only.
    """
    left: list[str] = []
    differing: set[tuple[str, Difference]] = set()
    print(f"{'class':22}{'':10}{'compared':>9}{'methods':>9}{'ruled':>7}{'open':>6}{'seconds':>9}")
    for name in names or ALL_ROBOTS:
        here: set[Difference] = set()
        compared = {}
        for part, comparison in COMPARISONS.items():
            start = time.perf_counter()
            # The maker's classes print the errors of a robot.
            with redirect_stdout(StringIO()):
                count, methods, found = comparison(ALL_ROBOTS[name])
            here |= found
            compared[part] = methods
            lacking = _shown(unruled(name, found))
            left += lacking
            counts = f"{count:9}{len(methods):9}{len(found) - len(lacking):7}{len(lacking):6}"
            print(f"{name:22}{part:10}{counts}{time.perf_counter() - start:9.1f}", flush=True)
        differing |= {(name, each) for each in here}
        left += _shown(stale(name, here, compared))
    if not names:
        left += _shown(unused(differing))
    for name in [each for each in names or sorted(library()) if each in library()]:
        with redirect_stdout(StringIO()):
            equal, listed, wrong = compare_migrated(name)
        print(f"{name:22}rewritten {equal:9} equal, {listed} to decide", flush=True)
        left += _shown(wrong)
    return 1 if left else 0


def _shown(texts: Iterable[str]) -> list[str]:
    """Print the differences without a ruling, and return them."""
    found = [*texts]
    for text in found:
        print(f"OPEN: {text}", flush=True)
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
