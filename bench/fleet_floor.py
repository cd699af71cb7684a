"""Poll many connections with nothing but asyncio callbacks: the floor of `fleet.py`."""

from __future__ import annotations

import asyncio
import socket
import time
from typing import NamedTuple

SECONDS = 3.0


class Floor(NamedTuple):
    """How late each reply came, and the CPU time of the process; in seconds."""

    lateness: list[float]
    cpu: float


async def run_floor(url: str, request: bytes, count: int, rate: float) -> Floor:
    """Send a request on each connection at that rate, the connections in turns."""
    host, _, port = url.removeprefix("socket://").partition(":")
    begin = time.monotonic() + SECONDS / 10
    lateness: list[float] = []
    polled = [
        _Polled((host, int(port)), request, begin + index / count / rate, 1 / rate, lateness)
        for index in range(count)
    ]
    cpu = time.process_time()
    await asyncio.sleep(begin + SECONDS - time.monotonic())
    cpu = time.process_time() - cpu
    for each in polled:
        each.close()
    return Floor(lateness, cpu)


class _Polled:
    """A connection that is polled."""

    def __init__(
        self,
        address: tuple[str, int],
        request: bytes,
        at: float,
        period: float,
        lateness: list[float],
    ) -> None:
        self._loop = asyncio.get_running_loop()
        self._socket = socket.create_connection(address)
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._request, self._at, self._period = request, at, period
        self._lateness = lateness
        self._loop.add_reader(self._socket, self._ready)
        self._timer = self._loop.call_at(at, self._send)

    def _send(self) -> None:
        self._socket.send(self._request)

    def _ready(self) -> None:
        now = self._loop.time()
        self._socket.recv(4096)
        self._lateness.append(now - self._at)
        self._at += self._period
        while self._at < now:
            self._at += self._period
        self._timer = self._loop.call_at(self._at, self._send)

    def close(self) -> None:
        self._timer.cancel()
        self._loop.remove_reader(self._socket)
        self._socket.close()
