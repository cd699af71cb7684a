"""The loop that serves clients, whatever they come by; one thread for all of them."""

from __future__ import annotations

import os
import selectors
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

from cobotwire.sim.channel import Channel, End
from cobotwire.sim.clock import RunningClock
from cobotwire.sim.line import Line
from cobotwire.sim.peer import Peer

READ, WRITE = selectors.EVENT_READ, selectors.EVENT_WRITE


class Server(ABC):
    """Serves while its ``with`` block runs, in a thread, or as long as :meth:`serve` is called."""

    url: str

    def __init__(self, clock: RunningClock | None) -> None:
        """``clock``: by which the peers count how long they wait; left out: real time."""
        self._clock = RunningClock() if clock is None else clock
        self._channels: dict[int, Channel] = {}
        self._selector = selectors.DefaultSelector()
        # A byte written to ``stopper`` ends :meth:`serve`.
        self._stop, self.stopper = os.pipe()
        os.set_blocking(self.stopper, False)
        self._selector.register(self._stop, READ)
        self._thread = threading.Thread(target=self.serve, name="cobotwire-sim", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.stop()
        self._thread.join()
        self.close()

    def serve(self, looks: Sequence[Callable[[], None]] = (), every: float = 0.25) -> None:
        """Answer until :meth:`stop` is called; ``looks`` are called ``every`` so many seconds."""
        look_at = time.monotonic() if looks else None
        while True:
            for key, events in self._selector.select(self._wait(look_at)):
                if key.fd == self._stop:
                    return
                self._ready(key.fd, events)
            for channel in tuple(self._channels.values()):
                self._tell(channel)
            if look_at is not None and time.monotonic() >= look_at:
                for look in looks:
                    look()
                look_at = time.monotonic() + every

    def stop(self) -> None:
        """End :meth:`serve`; may be called from another thread or a signal handler."""
        os.write(self.stopper, b"x")

    def close(self) -> None:
        """Give everything back; whoever is connected hears that the arm is gone."""
        for channel in tuple(self._channels.values()):
            self._drop(channel)
        self._selector.close()
        for descriptor in (self._stop, self.stopper):
            os.close(descriptor)

    @abstractmethod
    def _ready(self, descriptor: int, events: int) -> None:
        """Something is to be done with a descriptor that was registered."""

    def _connect(self, end: End, peer: Peer) -> None:
        self._channels[end.descriptor] = Channel(end, Line(peer, self._clock))
        self._selector.register(end.descriptor, READ)

    def _drop(self, channel: Channel) -> None:
        self._selector.unregister(channel.end.descriptor)
        del self._channels[channel.end.descriptor]
        channel.end.close()

    def _hear(self, descriptor: int, events: int) -> None:
        channel = self._channels[descriptor]
        if events & READ and not channel.hear():
            self._drop(channel)

    def _tell(self, channel: Channel) -> None:
        if not channel.tell():
            self._drop(channel)
        elif channel.full != bool(channel.line.unread):
            channel.full = not channel.full
            events = READ | WRITE if channel.full else READ
            self._selector.modify(channel.end.descriptor, events)

    def _wait(self, look_at: float | None) -> float | None:
        """For how many real seconds there is nothing to do unless something comes."""
        waits = [channel.line.wait for channel in self._channels.values()]
        real = [wait / self._clock.rate for wait in waits if wait is not None]
        if look_at is not None:
            real.append(max(0.0, look_at - time.monotonic()))
        return min(real, default=None)
