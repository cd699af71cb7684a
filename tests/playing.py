"""Play a conversation with a peer in stepped time."""

from __future__ import annotations

from collections.abc import Iterable

from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import TICK_SECONDS
from cobotwire.simulator.peer import Peer

Received = list[tuple[float, bytes]]


def play(
    peer: Peer,
    clock: SteppedClock,
    writes: Iterable[tuple[float, bytes]],
    received: Received | None = None,
) -> Received:
    """Write bytes, each some seconds after the ones before; return what came, and when.

    Time passes as in a server, which flushes the peer whenever it is due. Bytes of the same time
    are one piece. With ``received``, the pieces are added to it.
    """
    received = [] if received is None else received
    for pause, data in writes:
        until = clock() + pause
        while (wait := peer.wait) is not None and clock() + wait <= until:
            clock.sleep(wait)
            sent = peer.flush()
            _note(received, clock(), sent)
            # Time must advance even if a wait is only a rounding error.
            clock.sleep(0.0 if sent or wait >= TICK_SECONDS else TICK_SECONDS)
        clock.sleep(until - clock())
        if data:
            _note(received, clock(), peer.receive(data))
    return received


def _note(received: Received, now: float, data: bytes) -> None:
    if data and received and received[-1][0] == now:
        received[-1] = now, received[-1][1] + data
    elif data:
        received.append((now, data))
