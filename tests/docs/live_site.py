"""Serve the page live/ with a strict policy; its serial port is a simulated arm."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from cobotwire.editions.mycobot280.table import TABLE
from cobotwire.simulator import SimulatedArm, TcpServer
from live_page import POLICY

STOP = bytes.fromhex("FE FE 02 29 FA")
# The script of the page and the worker each have this port.
PORT = """
const port = {
  getInfo: () => ({ usbVendorId: 0x1a86, usbProductId: 0x55d4 }),
  async open() {
    const socket = new WebSocket(`ws://${location.host}/port`);
    socket.binaryType = "arraybuffer";
    await new Promise((done) => (socket.onopen = done));
    const start = (received) => {
      socket.onmessage = ({ data }) => received.enqueue(new Uint8Array(data));
      socket.onclose = () => received.error(new Error("The device has been lost."));
    };
    port.readable = new ReadableStream({ start });
    port.writable = new WritableStream({ write: (data) => socket.send(data) });
    port.close = async () => socket.close();
  },
};
const serial = { requestPort: async () => port, getPorts: async () => [port] };
Object.defineProperty(navigator, "serial", { value: serial });
"""


class LiveSite:
    """The page at ``url``, and the arm that is plugged in.

    Attributes:
        sent: the bytes that the page has written to its port.
        stopped_at: when the last stop was written, by the monotonic clock.
    """

    def __init__(self, folder: Path, arm: TcpServer, before: str, url: str) -> None:
        self._folder, self._arm, self._before, self.url = folder, arm, before, url
        self.sent, self.stopped_at = bytearray(), 0.0
        self._sockets: set[WebSocket] = set()
        self._loop: asyncio.AbstractEventLoop | None = None

    def unplug(self) -> None:
        """Let the port disappear."""
        for port in [*self._sockets]:
            assert self._loop is not None
            asyncio.run_coroutine_threadsafe(port.close(), self._loop).result(5)

    async def file(self, request: Request) -> Response:
        """Serve a file; the worker has a port too."""
        name = request.path_params["name"] or "index.html"
        headers = {"cache-control": "no-store"}
        if name != "index.html":  # which has the policy in itself
            headers["content-security-policy"] = POLICY
        if name in ("source.js", "worker.js"):
            text = self._before + (self._folder / name).read_text("utf-8")
            return Response(text, media_type="text/javascript", headers=headers)
        return FileResponse(self._folder / name, headers=headers)

    async def port(self, page: WebSocket) -> None:
        """Forward between the page and the arm."""
        self._loop = asyncio.get_running_loop()
        await page.accept()
        self._sockets.add(page)
        host, _, port = self._arm.url.removeprefix("socket://").rpartition(":")
        reader, writer = await asyncio.open_connection(host, int(port))
        replies = asyncio.create_task(self._replies(reader, page))
        try:
            while True:
                data = await page.receive_bytes()
                self.sent += data
                if STOP in data:
                    self.stopped_at = time.monotonic()
                writer.write(data)
        except (WebSocketDisconnect, RuntimeError):
            self._sockets.discard(page)
        replies.cancel()
        writer.close()

    async def _replies(self, reader: asyncio.StreamReader, page: WebSocket) -> None:
        while data := await reader.read(4096):
            await page.send_bytes(data)


@contextmanager
def serving(folder: Path, before: str = PORT) -> Iterator[LiveSite]:
    """Serve the page and an arm; a script comes before those of the page and the worker."""
    with TcpServer(SimulatedArm(TABLE, powered=True).connect) as arm, socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        listening.listen()
        site = LiveSite(folder, arm, before, f"http://127.0.0.1:{listening.getsockname()[1]}/")
        routes = [WebSocketRoute("/port", site.port), Route("/{name:path}", site.file)]
        app = Starlette(routes=routes)
        config = uvicorn.Config(app, log_level="error", ws="websockets-sansio")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, args=([listening],), daemon=True)
        thread.start()
        try:
            yield site
        finally:
            server.should_exit = True
            site.unplug()
            thread.join(5)
