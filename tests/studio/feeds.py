"""Watch a studio as a page does, without a browser."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from studio.studio_server import SECONDS, Studio


class Feed:
    """The feed of one page: what it received, and the newest states."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.entries: list[dict[str, Any]] = []
        self.samples: list[dict[str, Any]] = []
        self.states: dict[str, Any] = {}

    def take(self) -> dict[str, Any]:
        """Receive one batch; return its states."""
        batch = json.loads(self.connection.recv(timeout=SECONDS))
        states: dict[str, Any] = batch["states"]
        if states.get("cleared"):
            self.entries.clear()
            self.samples.clear()
        self.entries += batch["entries"]
        self.samples += batch["samples"]
        self.states |= states
        return states

    def state(self, name: str) -> Any:
        """Return the next state of that name."""
        while name not in (states := self.take()):
            pass
        return states[name]

    def until(self, condition: Callable[[], object]) -> None:
        """Receive batches until something is true."""
        end = time.monotonic() + SECONDS
        while not condition():
            assert time.monotonic() < end, (self.states, self.entries[-5:])
            self.take()

    def wish(self, wish: str, **values: Any) -> None:
        """Send what the page wants, such as ``stop``."""
        self.connection.send(json.dumps({"wish": wish, **values}))


@contextmanager
def watching(studio: Studio, origin: str | None = None, token: str | None = None) -> Iterator[Feed]:
    """Open the feed as a page does, or with another origin ("": none) or token."""
    secret = studio.token if token is None else token
    with connect(
        f"ws://127.0.0.1:{studio.port}/api/feed",
        origin=Origin(studio.origin) if origin is None else Origin(origin) if origin else None,
        subprotocols=[Subprotocol("cobotwire-studio"), Subprotocol(f"token.{secret}")],
        compression=None,
    ) as connection:
        yield Feed(connection)
