"""The outermost layer of the server: refuse requests, limit their size, set the headers."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, MutableMapping
from contextlib import suppress
from typing import Any

from cobotwire.studio.access import HEADERS, Access
from cobotwire.studio.connections import Connection, Connections

# Arguments of one command are the largest thing that a page sends.
LARGEST_BODY = 64 << 10
# No address of the page has more characters.
LONGEST_PATH = 200
# How much of the body of a refused request is read, in bytes, and for how long, in seconds.
DISCARDED = 1 << 20
DISCARD_SECONDS = 2.0
# The scope of a request has its connection as this state.
SCOPE_STATE = "connection"

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]


class Gate:
    """An ASGI application that passes permitted requests to another one."""

    def __init__(self, inner: App, access: Access, connections: Connections) -> None:
        self._inner, self._access, self._connections = inner, access, connections

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request, a WebSocket, or the start and the end of the server."""
        if scope["type"] == "lifespan":
            await self._inner(scope, receive, send)
            return
        connection: Connection = scope["state"][SCOPE_STATE]
        try:
            await self._serve(scope, receive, send, connection)
        finally:
            self._connections.end(connection)

    async def _serve(
        self, scope: Scope, receive: Receive, send: Send, connection: Connection
    ) -> None:
        headers: dict[str, str] = {}
        for name, value in scope["headers"]:
            text = value.decode("latin-1")
            key = name.decode("latin-1").lower()
            # A second host or origin must not hide the first: together they match nothing.
            headers[key] = f"{headers[key]}, {text}" if key in headers else text
        socket = scope["type"] == "websocket"
        method = "WEBSOCKET" if socket else scope["method"]
        refusal = self._access.refusal(method, scope["path"], headers)
        known = refusal is None and self._access.knows(headers)
        self._connections.begin(connection, known)
        if refusal is None and not headers.get("content-length", "0").isdigit():
            refusal = 400, "the content length is not a number"
        if refusal is None and int(headers.get("content-length", "0")) > LARGEST_BODY:
            refusal = 413, "the request is too long"
        if refusal is None and len(scope["path"]) > LONGEST_PATH:
            refusal = 414, "the address is too long"
        if refusal is None and "transfer-encoding" in headers:
            refusal = 411, "the request lacks its length"
        if refusal is None:
            await self._inner(scope, receive, send if socket else _with_headers(send))
        elif socket:
            # Before it is accepted, closing a WebSocket is the HTTP status 403.
            await send({"type": "websocket.close", "code": 1008})
        else:
            await _discard_body(receive)
            await _refuse(_with_headers(send), *refusal)


def _with_headers(send: Send) -> Send:
    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            own = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
            names = {name for name, _ in own}
            rest = [pair for pair in message.get("headers", ()) if pair[0].lower() not in names]
            message = {**message, "headers": [*rest, *own]}
        await send(message)

    return sending


async def _discard_body(receive: Receive) -> None:
    # A connection that is closed before its body was read is reset, and the answer can be lost.
    left = DISCARDED
    with suppress(TimeoutError):
        async with asyncio.timeout(DISCARD_SECONDS):
            while left > 0:
                message = await receive()
                left -= len(message.get("body", b""))
                if not message.get("more_body", False):
                    return


async def _refuse(send: Send, status: int, reason: str) -> None:
    text = ("content-type", "text/plain; charset=utf-8")
    headers = [tuple(part.encode() for part in text), (b"connection", b"close")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": f"{reason}\n".encode()})
