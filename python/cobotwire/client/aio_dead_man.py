"""A dead man's switch for asyncio."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from math import inf
from typing import Self

from cobotwire.client.aio import AsyncClient
from cobotwire.client.dead_man import Silence


class AsyncDeadMan:
    """Sends ``stop`` once when :meth:`alive` was not called for some seconds.

    It is :class:`cobotwire.DeadMan` for asyncio, with ``async with``; a task watches the time.

    Attributes:
        stops: how often the arm was stopped.
    """

    def __init__(self, arm: AsyncClient, seconds: float) -> None:
        """Store the arguments.

        Raises:
            UsageError: ``seconds`` is not above 0 and below 3600, or the edition has no stop.
        """
        arm.table.in_role("stop")
        self._arm, self._now, self.stops = arm, arm._connection.now, 0
        self._silence = Silence(seconds)
        self._fed = asyncio.Event()
        self._error: Exception | None = None
        self._task: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        self.alive()
        self._task = asyncio.create_task(self._watch())
        return self

    async def __aexit__(self, *error: object) -> None:
        assert self._task is not None, "the block was entered"
        self._task.cancel()
        with suppress(asyncio.CancelledError):
            await self._task

    def alive(self) -> None:
        """Note a sign of life.

        Raises:
            LinkError: the last stop could not be sent. Any other error of sending it, such as one
                of a traffic listener, is raised, too.
        """
        self._silence.alive(self._now())
        self._fed.set()
        error, self._error = self._error, None
        if error is not None:
            raise error

    def rest(self) -> None:
        """Stop watching until the next sign of life, because the arm is at rest."""
        self._silence.rest()

    async def _watch(self) -> None:
        while True:
            left = self._silence.left(self._now())
            if left == inf:
                self._fed.clear()
                await self._fed.wait()
            elif left > 0:
                await asyncio.sleep(left)
            else:
                self._silence.rest()
                try:
                    await self._arm._stop_all()
                except Exception as error:
                    # Also one of a traffic listener: the task must live to send the next stop.
                    self._error = error
                self.stops += 1
