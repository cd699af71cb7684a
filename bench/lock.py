"""Measure the cost of holding or releasing the interpreter's lock during a call.

Small input is decoded under the lock, large input without it. For sizes on both sides of the
threshold, this prints the time of a call, alone and next to a thread that is busy in Python.
"""

from __future__ import annotations

import statistics
import sys
import threading
import time

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from streams import stream_a

SIZES = [1 << size for size in range(12, 24)]
TURNS = 31


def main() -> None:
    """Measure and print."""
    codec = codecs.load(TABLE, "native")
    data = stream_a(TABLE, SIZES[-1] // 14).data
    print(f"the interpreter switches threads every {sys.getswitchinterval() * 1e3:g} ms")
    print(f"{'bytes':>10} {'alone':>12} {'next to a busy thread':>22}")
    for size in SIZES:
        part = data[:size]
        alone = _median(codec, part)
        with _Busy():
            beside = _median(codec, part)
        print(f"{size:10,} {alone * 1e6:9,.0f} us {beside * 1e6:19,.0f} us")


def _median(codec: Codec, data: bytes) -> float:
    seconds = []
    for _ in range(TURNS):
        started = time.perf_counter()
        codec.decode_columns(data, "reply")
        seconds.append(time.perf_counter() - started)
    return statistics.median(seconds)


class _Busy:
    """A context in which another thread is busy in Python."""

    def __enter__(self) -> None:
        self.stop = False
        self.thread = threading.Thread(target=self._count)
        self.thread.start()

    def __exit__(self, *exception: object) -> None:
        self.stop = True
        self.thread.join()

    def _count(self) -> None:
        count = 0
        while not self.stop:
            count += 1


if __name__ == "__main__":
    main()
