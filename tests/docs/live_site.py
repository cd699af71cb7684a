"""Serve the page live/ with a strict policy; the only serial port is a simulated arm at a WebSocket."""

from __future__ import annotations

import asyncio
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

    def __init__(self, folder: Path, arm: TcpServer, before: str) -> None:
        self._folder, self._arm, self._before = folder, arm, before
        self.sent, self.stopped_at, self.url = bytearray(), 0.0, ""
        self._sockets: set[WebSocket] = set()
        self._loop: asyncio.AbstractEventLoop | None = None

    def unplug(self) -> None:
        """Let the port disappear."""
        assert self._loop is not None
        for socket in [*self._sockets]:
            asyncio.run_coroutine_threadsafe(socket.close(), self._loop).result(5)

    async def file(self, request: Request) -> Response:
        """Serve a file; the worker has a port too."""
        name = request.path_params["name"] or "index.html"
        headers = {"content-security-policy": POLICY, "cache-control": "no-store"}
        if name in ("source.js", "worker.js"):
            text = self._before + (self._folder / name).read_text("utf-8")
            return Response(text, media_type="text/javascript", headers=headers)
        path = self._folder / name
        kinds = {".wasm": "application/wasm", ".js": "text/javascript"}
        return FileResponse(path, media_type=kinds.get(path.suffix), headers=headers)

    async def port(self, socket: WebSocket) -> None:
        """Forward between the page and the arm."""
        self._loop = asyncio.get_running_loop()
        await socket.accept()
        self._sockets.add(socket)
        host, _, port = self._arm.url.removeprefix("socket://").rpartition(":")
        reader, writer = await asyncio.open_connection(host, int(port))
        replies = asyncio.create_task(self._replies(reader, socket))
        try:
            while True:
                data = await socket.receive_bytes()
                self.sent += data
                if STOP in data:
                    self.stopped_at = time.monotonic()
                writer.write(data)
        except (WebSocketDisconnect, RuntimeError):
            self._sockets.discard(socket)
        replies.cancel()
        writer.close()

    async def _replies(self, reader: asyncio.StreamReader, socket: WebSocket) -> None:
        while data := await reader.read(4096):
            await socket.send_bytes(data)


@contextmanager
def serving(folder: Path, before: str = PORT) -> Iterator[LiveSite]:
    """Serve the page and an arm; a script comes before those of the page and the worker."""
    with TcpServer(SimulatedArm(TABLE, powered=True).connect) as arm:
        site = LiveSite(folder, arm, before)
        routes = [WebSocketRoute("/port", site.port), Route("/{name:path}", site.file)]
        config = uvicorn.Config(Starlette(routes=routes), port=0, log_level="error", ws="websockets-sansio")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run)
        thread.start()
        while not server.started:
            thread.join(0.01)
        port = server.servers[0].sockets[0].getsockname()[1]
        site.url = f"http://127.0.0.1:{port}/"
        yield site
        server.should_exit = True
        site.unplug() if site._sockets else None
        thread.join()
