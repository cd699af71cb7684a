"""Defines the two kinds of clients, blocking and asyncio; the same templates generate both."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Way:
    """What differs between a blocking and an asyncio client."""

    kind: str
    folder: str
    prefix: str
    module: str
    client: str
    async_: str
    await_: str
    block: str
    moving_module: str


BLOCKING = Way(
    "blocking",
    "commands",
    "",
    "cobotwire.client",
    "Client",
    "",
    "",
    "a ``with``",
    "cobotwire.client.moving",
)
ASYNCIO = Way(
    "asyncio",
    "aio",
    "Async",
    "cobotwire.client.aio",
    "AsyncClient",
    "async ",
    "await ",
    "an ``async with``",
    "cobotwire.client.aio_moving",
)
WAYS = (BLOCKING, ASYNCIO)
