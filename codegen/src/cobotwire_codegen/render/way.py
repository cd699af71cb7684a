"""The ways in which a client is called: each gets a client from the same templates."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Way:
    """How a client is called: one description of the commands gives a client for each way."""

    kind: str
    folder: str
    prefix: str
    module: str
    driver: str
    async_: str
    await_: str
    block: str
    moving_module: str


BLOCKING = Way(
    "blocking",
    "commands",
    "",
    "cobotwire.driver",
    "Driver",
    "",
    "",
    "a ``with``",
    "cobotwire.driver.moving",
)
ASYNCIO = Way(
    "asyncio",
    "aio",
    "Async",
    "cobotwire.driver.aio",
    "AsyncDriver",
    "async ",
    "await ",
    "an ``async with``",
    "cobotwire.driver.aio_moving",
)
WAYS = (BLOCKING, ASYNCIO)
