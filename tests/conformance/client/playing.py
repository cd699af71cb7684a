"""Let a referee receive what a client writes, in stepped time."""

from __future__ import annotations

from collections.abc import Iterable

from cobotwire.conformance.client import Referee
from cobotwire.simulator.clock import SteppedClock


def play(
    referee: Referee, clock: SteppedClock, writes: Iterable[tuple[float, bytes]]
) -> list[tuple[float, bytes]]:
    """Write bytes, each some seconds after the ones before; return what came, and when.

    Time passes as in a server, which flushes the referee whenever it is due.
    """
    received = []
    for after, data in writes:
        until = clock() + after
        while (wait := referee.wait) is not None and clock() + wait <= until:
            clock.sleep(wait)
            received.append((round(clock(), 3), referee.flush()))
        clock.sleep(until - clock())
        if data:
            received.append((round(clock(), 3), referee.receive(data)))
    return [(at, data) for at, data in received if data]
