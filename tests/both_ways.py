"""Wrap the asyncio client in the blocking client's interface, so that one test covers both."""

from __future__ import annotations

import asyncio
import inspect
import threading
from collections.abc import Callable
from typing import Any, Self

from cobotwire.client import Client
from cobotwire.client.aio import AsyncClient


class InLoop:
    """Run an asyncio client in the loop of a separate thread; every call waits for its result."""

    def __init__(self, client: type[AsyncClient], *arguments: Any, **options: Any) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        try:
            self.client = client(*arguments, **options)
            self.run(self.client.open())
        except BaseException:
            self.end()
            raise

    def __getattr__(self, name: str) -> Any:
        return self._blocking(getattr(self.client, name))

    def at(self, address: int | str) -> Any:
        return self._blocking(self.client.at(address))

    def _blocking(self, found: Any) -> Any:
        """Return an attribute in the blocking client's interface."""
        if isinstance(found, AsyncClient):
            return _ViewInLoop(self, found)
        if not inspect.iscoroutinefunction(found):
            return found
        return lambda *arguments, **options: self.run(found(*arguments, **options))

    def stream(self, *requests: Any, **options: Any) -> _StreamInLoop:
        return _StreamInLoop(self.run, self.client.stream(*requests, **options))

    def run(self, work: Any) -> Any:
        """Run a coroutine in the loop; return its result."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: Any) -> None:
        self.run(self.client.__aexit__(*raised))
        self.end()

    def end(self) -> None:
        """End the loop and its thread."""
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


class _ViewInLoop:
    """A client for another address, in the loop of the first."""

    def __init__(self, arm: InLoop, client: AsyncClient) -> None:
        self._arm, self._client = arm, client

    def __getattr__(self, name: str) -> Any:
        return self._arm._blocking(getattr(self._client, name))


class _StreamInLoop:
    """A stream of an asyncio client as an ordinary iterator."""

    def __init__(self, run: Callable[[Any], Any], stream: Any) -> None:
        self.run = run
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> Any:
        try:
            return self.run(self._stream.__anext__())
        except StopAsyncIteration:
            raise StopIteration from None


Opener = Callable[..., Any]


def openers(blocking: type[Client], asynchronous: type[AsyncClient]) -> dict[str, Opener]:
    """Return functions that open the blocking or the asyncio client, both with one interface."""

    def in_loop(*arguments: Any, **options: Any) -> InLoop:
        return InLoop(asynchronous, *arguments, **options)

    return {"blocking": blocking, "asyncio": in_loop}
