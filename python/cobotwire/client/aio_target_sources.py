"""Live sources of targets for asyncio: a task reads them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterable

from cobotwire.client.target_sources import Mailbox
from cobotwire.session.paths import Target

AsyncTargets = AsyncIterable[Target]


class TaskMailbox(Mailbox):
    """The targets of an asynchronous iterator."""

    def __init__(self, source: AsyncTargets) -> None:
        super().__init__()
        self._task = asyncio.ensure_future(self._read(source))

    async def _read(self, source: AsyncTargets) -> None:
        try:
            async for target in source:
                self.put(target)
                # A source that never waits must not keep the loop for itself.
                await asyncio.sleep(0)
            self.end()
        except Exception as error:
            self.end(error)

    def close(self) -> None:
        """Cancel the task."""
        self._task.cancel()
