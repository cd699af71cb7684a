"""The asyncio client behind the face of the blocking one, so that one test holds for both."""

from __future__ import annotations

import asyncio
import inspect
import threading
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

from cobotwire.driver import Driver
from cobotwire.driver.aio import AsyncDriver


class InLoop:
    """Runs an asyncio client in a loop of its own thread; every call waits for its result."""

    def __init__(self, client: type[AsyncDriver], *arguments: Any, **options: Any) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        try:
            self.client = client(*arguments, **options)
            self._run(self.client.open())
        except BaseException:
            self._end()
            raise

    def __getattr__(self, name: str) -> Any:
        found = getattr(self.client, name)
        if not inspect.iscoroutinefunction(found):
            return found
        return lambda *arguments, **options: self._run(found(*arguments, **options))

    def stream(self, *queries: Any, **options: Any) -> _StreamInLoop:
        return _StreamInLoop(self._run, self.client.stream(*queries, **options))

    def _run(self, work: Any) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._run(self.client.close())
        self._end()

    def _end(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


class _StreamInLoop:
    """A stream of an asyncio client, gone through by an ordinary loop."""

    def __init__(self, run: Callable[[Any], Any], stream: Any) -> None:
        self._run = run
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> Any:
        try:
            return self._run(self._stream.__anext__())
        except StopAsyncIteration:
            raise StopIteration from None


Opener = Callable[..., Any]


def openers(blocking: type[Driver], asynchronous: type[AsyncDriver]) -> dict[str, Opener]:
    """How a test opens an arm in each way; what comes back is used alike."""

    def in_loop(*arguments: Any, **options: Any) -> InLoop:
        return InLoop(asynchronous, *arguments, **options)

    return {"blocking": blocking, "asyncio": in_loop}
