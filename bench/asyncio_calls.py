"""Measure the processor time of a call of the asyncio client, with 1, 10 and 100 arms over TCP.

The time is that of this process alone, system calls included; the arms are in another process. It
is compared with the least that asyncio needs for the same bytes: a send, a future, and a reader
that receives. The two alternate, and the fastest turn of each counts.
"""

from __future__ import annotations

import asyncio
import socket
import subprocess
import sys
import time
from typing import Protocol

from cobotwire.editions.mycobot280 import AsyncMyCobot280
from responder import within

REQUEST = bytes.fromhex("FE FE 02 20 FA")
REPLY = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
ARMS = f"""
import selectors, socket
server = socket.create_server(("127.0.0.1", 0), backlog=4096)
print(server.getsockname()[1], flush=True)
selector = selectors.DefaultSelector()
selector.register(server, selectors.EVENT_READ)
while True:
    for key, _ in selector.select():
        if key.fileobj is server:
            arm, _ = server.accept()
            arm.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            selector.register(arm, selectors.EVENT_READ)
        elif key.fileobj.recv(4096):
            key.fileobj.send({REPLY!r})
        else:
            selector.unregister(key.fileobj)
            key.fileobj.close()
"""
TURNS, CALLS, WARM_UP = 8, 3000, 20
# The limit of the ratio to bare asyncio, with 10 arms.
LIMIT = 2.5


class _Arm(Protocol):
    async def open(self) -> None: ...
    async def close(self) -> None: ...
    async def get_angles(self) -> object: ...


class _Bare:
    """The same exchange with asyncio and a socket alone."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port))
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)

    async def open(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(self._socket.fileno(), self._receive)

    async def close(self) -> None:
        self._loop.remove_reader(self._socket.fileno())
        self._socket.close()

    async def get_angles(self) -> bytes:
        self._reply: asyncio.Future[bytes] = self._loop.create_future()
        self._socket.send(REQUEST)
        return await self._reply

    def _receive(self) -> None:
        self._reply.set_result(self._socket.recv(4096))


def main() -> None:
    """Measure, and print the ratios."""
    command = [sys.executable, "-c", ARMS]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        port = int(process.stdout.readline())
        try:
            for count in (1, 10, 100):
                _compare(port, count)
        finally:
            process.kill()


def _compare(port: int, count: int) -> None:
    ours, bare = [], []
    for _ in range(TURNS):
        arms: list[_Arm] = [
            AsyncMyCobot280(f"socket://127.0.0.1:{port}", on_error="leave") for _ in range(count)
        ]
        ours.append(asyncio.run(_seconds(arms)))
        bare.append(asyncio.run(_seconds([_Bare(port) for _ in range(count)])))
    ratio = min(ours) / min(bare)
    verdict = f"   {within(ratio <= LIMIT)} {LIMIT:g} x" if count == 10 else ""
    print(
        f"asyncio call, {count:3} arms in a loop {min(ours) * 1e6:6.1f} us of own CPU   "
        f"{ratio:4.1f} x bare asyncio ({min(bare) * 1e6:.1f} us){verdict}"
    )


async def _seconds(arms: list[_Arm]) -> float:
    """Return the processor time of a call, in seconds."""
    for arm in arms:
        await arm.open()
    await _call(arms, WARM_UP)
    calls = CALLS // len(arms)
    started = time.process_time()
    await _call(arms, calls)
    spent = time.process_time() - started
    for arm in arms:
        await arm.close()
    return spent / (calls * len(arms))


async def _call(arms: list[_Arm], times: int) -> None:
    async def in_turn(arm: _Arm) -> None:
        for _ in range(times):
            await arm.get_angles()

    await asyncio.gather(*[in_turn(arm) for arm in arms])


if __name__ == "__main__":
    main()
