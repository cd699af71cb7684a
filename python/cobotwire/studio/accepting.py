"""Accept connections for uvicorn, one at a time, and close those that wait for too long."""

from __future__ import annotations

import asyncio
import errno
import logging
import socket
from contextlib import suppress
from typing import Any

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from cobotwire.studio.connections import Connection, Connections
from cobotwire.studio.gate import SCOPE_STATE

# How many connections the system keeps until they are accepted. If there are more, a client tries
# again after a second.
QUEUE = 4096
# The period of the search for connections that have waited too long.
SWEEP_SECONDS = 1.0
# The errors if the process can open no file for a connection, and the pause after such an error.
NO_MORE_FILES = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
PAUSE_SECONDS = 0.05


class Server(uvicorn.Server):
    """A uvicorn server that accepts its connections itself, and reports them to ``connections``."""

    def __init__(
        self, config: uvicorn.Config, listening: socket.socket, connections: Connections
    ) -> None:
        super().__init__(config)
        self._listening, self._open = listening, connections
        self._tasks: list[asyncio.Task[None]] = []
        listening.setblocking(False)
        listening.listen(QUEUE)
        logging.getLogger("uvicorn.error").addFilter(_shorten)

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start as uvicorn does, without a socket of its own."""
        await super().startup(sockets=[])
        self._tasks = [asyncio.create_task(self._accept()), asyncio.create_task(self._sweep())]

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Accept nothing more, and close the connections."""
        for task in self._tasks:
            task.cancel()
        await super().shutdown(sockets=[])

    async def _accept(self) -> None:
        # asyncio's own servers accept thousands of connections before they read from the first.
        loop = asyncio.get_running_loop()
        while True:
            try:
                accepted, _ = await loop.sock_accept(self._listening)
            except OSError as error:
                # Other errors mean that this peer has disconnected; other connections continue.
                if error.errno in NO_MORE_FILES:
                    self._open.make_room()
                await asyncio.sleep(PAUSE_SECONDS if error.errno in NO_MORE_FILES else 0)
                continue
            with suppress(OSError):
                await loop.connect_accepted_socket(self._protocol, accepted)

    def _protocol(self) -> asyncio.Protocol:
        return _Reported(self, self._open)

    async def _sweep(self) -> None:
        while True:
            await asyncio.sleep(SWEEP_SECONDS)
            self._open.close_overdue()


class _Reported(H11Protocol):
    """A connection that reports when it begins, ends, and becomes a WebSocket."""

    def __init__(self, server: Server, connections: Connections) -> None:
        super().__init__(server.config, server.server_state, server.lifespan.state)
        self._reports = connections

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        host = self.client[0] if self.client else ""
        self._connection = Connection(host, transport.abort)
        # The gate finds it in the scope of each request.
        self.app_state = {**self.app_state, SCOPE_STATE: self._connection}
        self._reports.arrive(self._connection)

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self._reports.leave(self._connection)

    def handle_websocket_upgrade(self, event: Any) -> None:
        super().handle_websocket_upgrade(event)
        # The gate now accepts or refuses it at once.
        self._reports.leave(self._connection)


def _shorten(record: logging.LogRecord) -> bool:
    """Log one line, without a traceback, if the other end sent bytes that are not text."""
    if record.exc_info and isinstance(record.exc_info[1], UnicodeError):
        record.msg, record.args = f"{record.getMessage()} {record.exc_info[1]}", ()
        record.exc_info = None
    return True
