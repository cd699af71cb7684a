"""The loop that serves clients; one thread serves all of them."""

from __future__ import annotations

import selectors
import socket
import threading
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple, Self

from cobotwire.simulator.client_connection import ClientConnection
from cobotwire.simulator.clock import RunningClock
from cobotwire.simulator.peer import Peer, PeerDisconnected

READ, WRITE = selectors.EVENT_READ, selectors.EVENT_WRITE
READ_SIZE = 4096
# A recorded pause may last weeks, for which select() would raise an error.
LONGEST_WAIT = 3600.0


class Endpoint(NamedTuple):
    """A non-blocking descriptor and its functions; an OSError reports a lost client."""

    descriptor: int
    read: Callable[[int], bytes]
    write: Callable[[bytes], int]
    close: Callable[[], None]


class Server:
    """Serves while its ``with`` block runs, in a thread, or as long as :meth:`serve` is called."""

    url: str

    def __init__(self, clock: RunningClock | None) -> None:
        """Prepare to serve; ``clock`` is the one that the peers use; None: real time."""
        self._clock = RunningClock() if clock is None else clock
        self._clients: dict[int, _Client] = {}
        self._selector = selectors.DefaultSelector()
        # A byte sent to the second one ends :meth:`serve`. On Windows, select() accepts no pipe.
        self._stop, self._stopper = socket.socketpair()
        self._stopper.setblocking(False)
        self._selector.register(self._stop, READ)
        self._thread = threading.Thread(target=self.serve, name="cobotwire-sim", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()
        self._thread.join()
        self.close()

    @property
    def stopper(self) -> int:
        """The descriptor for ``signal.set_wakeup_fd``: a byte written to it ends :meth:`serve`."""
        return self._stopper.fileno()

    def serve(self, callbacks: Sequence[Callable[[], None]] = (), every: float = 0.25) -> None:
        """Serve until :meth:`stop` is called; call ``callbacks`` every ``every`` seconds."""
        call_at = time.monotonic() if callbacks else None
        while True:
            for key, events in self._selector.select(self._wait(call_at)):
                if key.fileobj is self._stop:
                    return
                self._ready(key.fd, events)
            for client in tuple(self._clients.values()):
                self._send(client)
            if call_at is not None and time.monotonic() >= call_at:
                for callback in callbacks:
                    callback()
                call_at = time.monotonic() + every

    def stop(self) -> None:
        """End :meth:`serve`; another thread or a signal handler may call this."""
        self._stopper.send(b"x")

    def close(self) -> None:
        """Disconnect all clients, and release everything."""
        for client in tuple(self._clients.values()):
            self._drop(client)
        self._selector.close()
        self._stop.close()
        self._stopper.close()

    def _ready(self, descriptor: int, events: int) -> None:
        """Handle the descriptor of a client that is ready."""
        client = self._clients.get(descriptor)
        # The client may have been dropped since select() returned.
        if client is not None and events & READ and not client.receive():
            self._drop(client)

    def _connect(self, endpoint: Endpoint, peer: Peer) -> None:
        self._clients[endpoint.descriptor] = _Client(endpoint, ClientConnection(peer, self._clock))
        self._selector.register(endpoint.descriptor, READ)

    def _drop(self, client: _Client) -> None:
        if client.endpoint.descriptor in self._selector.get_map():
            self._selector.unregister(client.endpoint.descriptor)
        del self._clients[client.endpoint.descriptor]
        client.endpoint.close()

    def _send(self, client: _Client) -> None:
        if not client.send():
            self._drop(client)
        elif client.full != bool(client.connection.unread):
            client.full = not client.full
            events = READ | WRITE if client.full else READ
            if client.endpoint.descriptor in self._selector.get_map():
                self._selector.modify(client.endpoint.descriptor, events)

    def _wait(self, call_at: float | None) -> float | None:
        """Return how many real seconds to wait for arriving bytes; None: without a limit."""
        waits = [client.connection.wait for client in self._clients.values()]
        real = [wait / self._clock.rate for wait in waits if wait is not None]
        if call_at is not None:
            real.append(max(0.0, call_at - time.monotonic()))
        return min(*real, LONGEST_WAIT) if real else None


class _Client:
    """Carries bytes between a client and its connection, and blocks neither."""

    def __init__(self, endpoint: Endpoint, connection: ClientConnection) -> None:
        self.endpoint = endpoint
        self.connection = connection
        # Whether the client must take some replies before it gets more.
        self.full = False
        # When it sent bytes last, or connected; and whether it has sent any.
        self.active_at = time.monotonic()
        self.has_sent = False

    def receive(self) -> bool:
        """Receive what the client has sent; return whether client and peer are still connected."""
        try:
            data = self.endpoint.read(READ_SIZE)
        except BlockingIOError:
            return True
        except OSError:
            return False
        self.active_at, self.has_sent = time.monotonic(), True
        try:
            self.connection.receive(data)
        except PeerDisconnected:
            return False
        return bool(data)

    def send(self) -> bool:
        """Send as many replies as the client takes; return whether it is still connected."""
        try:
            self.connection.pass_time()
        except PeerDisconnected:
            return False
        while data := self.connection.take():
            try:
                taken = self.endpoint.write(data)
            except BlockingIOError:
                taken = 0
            except OSError:
                return False
            if taken < len(data):
                self.connection.put_back(data[taken:])
                break
        return True
