"""Measure what a blocking call does beside system calls: all of it in memory, and its parts alone.

In the place of the native call, which writes, waits, reads and decodes, a function returns a reply
that came before. The fastest of several turns counts.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from functools import partial

from client import REQUEST, RESPONDER
from cobotwire.client.native_call import NativeCall
from cobotwire.editions.mycobot import MyCobot
from cobotwire.editions.mycobot.messages.motion import GetAngles
from responder import responder

TURNS, CALLS = 40, 1000


def main() -> None:
    """Measure, and print nanoseconds without those of a call that does nothing."""
    with responder(RESPONDER) as url, MyCobot(url) as arm:
        arm.get_angles()
        parts = _parts(arm)
        best = dict.fromkeys(parts, float("inf"))
        for _ in range(TURNS):
            for name, part in parts.items():
                best[name] = min(best[name], _timed(part))
    nothing = best.pop("nothing")
    for name, seconds in best.items():
        print(f"{name:40} {(seconds - nothing) * 1e9:6.0f} ns")


def _parts(arm: MyCobot) -> dict[str, Callable[[], object]]:
    encoder, connection = arm._encoder, arm._connection
    native = connection._native
    assert isinstance(native, NativeCall), "the native module is not installed"
    steps, alone, policy = native._steps, native._alone, arm._settings.retry
    request = GetAngles()
    encoded = encoder.encode_request(request)
    writer = steps.writer
    found = native.swap(0.0, 1.0, REQUEST, "get_angles", writer.lock, writer.finish_write)
    assert isinstance(found, tuple), "the reply came in parts; run the bench again"
    frame, fields, _, _ = found
    native.swap = partial(steps._transport.lend, lambda *_: found)  # type: ignore[attr-defined]
    lock = threading.Lock()

    def state() -> None:
        alone.begin(encoded, steps.now(), policy.grace)
        alone.end(frame)

    def with_lock() -> None:
        with lock:
            pass

    def acquire_and_release() -> None:
        lock.acquire()
        lock.release()

    return {
        "nothing": lambda: None,
        "get_angles(), without the native call": arm.get_angles,
        "the request object": GetAngles,
        "its bytes": lambda: encoder.encode_request(request),
        "whether frames are logged": lambda: connection.listeners.silent,
        "the state of the exchange": state,
        "the result": lambda: request.result_of(fields),
        "with lock": with_lock,
        "lock.acquire() and lock.release()": acquire_and_release,
    }


def _timed(part: Callable[[], object]) -> float:
    started = time.perf_counter()
    for _ in range(CALLS):
        part()
    return (time.perf_counter() - started) / CALLS


if __name__ == "__main__":
    main()
