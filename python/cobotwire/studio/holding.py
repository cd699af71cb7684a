"""Motions that last only while a page holds a button.

They also end if the page is gone or stuck.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from typing import Any

from cobotwire.client.dead_man import Silence
from cobotwire.protocol.errors import CobotwireError
from cobotwire.studio.stage import Stage


class Holding:
    """The motion that one page holds; there is at most one."""

    def __init__(self, stage: Stage, page: str, refuse: Callable[[str], None]) -> None:
        """Hold nothing yet; ``refuse`` gets the text if a motion or stop was not sent."""
        self._stage, self._page, self._refuse = stage, page, refuse
        self._tasks: set[asyncio.Task[None]] = set()
        self._held, self._silence = False, Silence(stage.silence)

    def hold(self, command: object, arguments: object, stops: object) -> None:
        """Send a motion; it is stopped when the page releases it or falls silent.

        ``stops`` is the number of stops that the page knew when the user pressed the button.
        """
        if not self._held:
            self._held = True
            self._stage.held[self._page] = self.release
            self._start(self._watch())
        self.keep()
        self._start(self._send(command, arguments, stops))

    def keep(self) -> None:
        """Note that the page still holds."""
        self._silence.alive(time.monotonic())

    def release(self) -> bool:
        """Stop the arm, if the page holds a motion; return whether it did."""
        if not self._held:
            return False
        self._held = False
        self._stage.held.pop(self._page, None)
        self._start(self._stop())
        return True

    async def end(self) -> None:
        """Stop the arm if a motion is held, when the page has left."""
        self.release()
        await asyncio.gather(*self._tasks)

    async def _send(self, command: object, arguments: object, stops: object) -> None:
        try:
            await self._stage.send(self._page, command, arguments, stops, force=False)
        except CobotwireError as error:
            self._refuse(str(error))

    async def _watch(self) -> None:
        while self._held:
            left = self._silence.left(time.monotonic())
            if left <= 0:
                self.release()
                self._refuse(
                    "the arm was stopped: the page no longer reported that the button is held"
                )
                return
            await asyncio.sleep(left)

    async def _stop(self) -> None:
        try:
            await self._stage.stop()
        except CobotwireError as error:
            self._refuse(f"stop was NOT sent: {error}")

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
