"""Measure what a blocking call does beside system calls: all of it in memory, and its parts alone.

In the place of the native call, which does all from the check whether the request is alone to the
decoded reply, a function returns a reply that came before. The fastest of several turns counts.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from client import RESPONDER
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
    policy = arm._settings.retry
    request = GetAngles()
    encoded = encoder.encode_request(request)
    lone = native.lone
    answer = lone(native, encoded, policy, None, 0.0)
    assert answer is not None
    native.lone = lambda *_: answer
    fields = answer[0]
    leading = connection._steps.leading

    def refused() -> None:
        leading.leader = 0
        lone(native, encoded, policy, None, 0.0)
        leading.leader = None

    return {
        "nothing": lambda: None,
        "get_angles(), without the native call": arm.get_angles,
        "the request object": GetAngles,
        "its bytes": lambda: encoder.encode_request(request),
        "the call from the connection on": lambda: connection.call(encoded, policy, None),
        "whether frames are logged": lambda: connection.listeners.silent,
        "a native call that is refused": refused,
        "the result": lambda: request.result_of(fields),
    }


def _timed(part: Callable[[], object]) -> float:
    started = time.perf_counter()
    for _ in range(CALLS):
        part()
    return (time.perf_counter() - started) / CALLS


if __name__ == "__main__":
    main()
