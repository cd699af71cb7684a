"""The WebSocket of a page: entries go out in batches, a few kinds of messages come in.

A message of a page is a JSON object; its key ``wish`` names what the page requests: ``stop``;
``hold``, ``keep`` and ``release`` for a motion that lasts while a button is held; ``seek``,
``play`` and ``pause`` for a recording. Each ``stop`` and each ``release`` counts as a stop, here
and in the page.
"""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from cobotwire.protocol.errors import CobotwireError
from cobotwire.studio.access import PROTOCOL
from cobotwire.studio.holding import Holding
from cobotwire.studio.recorded import Player, RecordedSession
from cobotwire.studio.sending import NotPermitted
from cobotwire.studio.stage import Stage
from cobotwire.studio.viewers import Viewer

MOST_PAGES = 32


class Feed:
    """Serves the WebSockets of all pages of a stage."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage

    async def serve(self, socket: WebSocket) -> None:
        """Serve one page until it leaves."""
        if len(self._stage.viewers) >= MOST_PAGES:
            await socket.close(1013, "too many pages are open")
            return
        await socket.accept(subprotocol=PROTOCOL)
        viewer = Viewer()
        self._stage.open(viewer)
        player = None
        holding = Holding(self._stage, viewer.page, lambda text: viewer.show(refused=text))
        tasks = [asyncio.create_task(_send(socket, viewer))]
        if isinstance(self._stage.session, RecordedSession):
            player = Player(self._stage.session, viewer)
            tasks.append(asyncio.create_task(player.run()))
        tasks.append(asyncio.create_task(self._receive(socket, viewer, player, holding)))
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            self._stage.leave(viewer)
            await holding.end()

    async def _receive(
        self, socket: WebSocket, viewer: Viewer, player: Player | None, holding: Holding
    ) -> None:
        stops: set[asyncio.Task[None]] = set()
        while True:
            try:
                text = await socket.receive_text()
            except (WebSocketDisconnect, KeyError):
                return
            wish = _wish(text)
            if wish.get("wish") == "stop":
                # In a task of its own, so that a second stop is not held up by the first.
                task = asyncio.create_task(self._stop(viewer, wish.get("number")))
                stops.add(task)
                task.add_done_callback(stops.discard)
            elif player is not None:
                _play(player, viewer, wish)
            else:
                self._hold(holding, wish)

    def _hold(self, holding: Holding, wish: dict[str, Any]) -> None:
        if wish.get("wish") == "hold":
            holding.hold(wish.get("command"), wish.get("arguments"), wish.get("stops"))
        elif wish.get("wish") == "keep":
            holding.keep()
        elif wish.get("wish") == "release" and not holding.release():
            # The motion has ended already; the page counts its release as a stop nevertheless.
            with suppress(NotPermitted):
                self._stage.count_stop()

    async def _stop(self, viewer: Viewer, number: object) -> None:
        error = ""
        try:
            await self._stage.stop()
        except CobotwireError as failed:
            error = str(failed)
        shown = number if isinstance(number, int) else 0
        viewer.show(stopped={"number": shown, "error": error})


async def _send(socket: WebSocket, viewer: Viewer) -> None:
    async for batch in viewer.batches():
        # This waits while the page does not read; its queues then drop old entries.
        await socket.send_text(batch)


def _play(player: Player, viewer: Viewer, wish: dict[str, Any]) -> None:
    value = wish.get("value")
    number = float(value) if isinstance(value, int | float) else 0.0
    if wish.get("wish") == "seek" and number == number:
        player.seek(number)
    elif wish.get("wish") == "pause":
        player.pause()
    elif wish.get("wish") == "play":
        try:
            player.play(number)
        except CobotwireError as error:
            viewer.show(refused=str(error))


def _wish(text: str) -> dict[str, Any]:
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}
