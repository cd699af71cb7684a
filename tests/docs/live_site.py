"""Serve the page live/ with a strict policy; its serial port is a simulated arm."""

from __future__ import annotations

import mimetypes
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.sync.server import ServerConnection, serve

from cobotwire.editions.mycobot280.table import TABLE
from cobotwire.protocol.errors import LinkError
from cobotwire.protocol.table import Table
from cobotwire.simulator import MemoryTransport, SimulatedArm
from live_page import POLICY

STOP = bytes.fromhex("FE FE 02 29 FA")
# The script of the page and the worker each have this port. A page with the hash #none has no port.
PORT = """
const port = {
  getInfo: () => ({ usbVendorId: 0x1a86, usbProductId: 0x55d4 }),
  async open({ baudRate }) {
    if (port.opened) throw new Error("The port is already open.");
    port.opened = true;
    const socket = new WebSocket(`ws://${location.host}/port?${baudRate}`);
    socket.binaryType = "arraybuffer";
    await new Promise((done) => (socket.onopen = done));
    let received, written;
    port.readable = new ReadableStream({ start: (controller) => (received = controller) });
    const write = (data) => socket.send(data);
    port.writable = new WritableStream({ start: (controller) => (written = controller), write });
    socket.onmessage = ({ data }) => received.enqueue(new Uint8Array(data));
    const lost = (controller) => controller.error(new Error("The device has been lost."));
    const closed = new Promise((done) => (socket.onclose = done)).then(() => {
      port.opened = false;
      [received, written].map(lost);
    });
    // Like a real port, it counts as open until closing is complete.
    port.close = async () => {
      if (port.readable.locked || port.writable.locked) return;
      socket.close();
      await closed;
    };
  },
};
if (location.hash === "#none") delete Navigator.prototype.serial;
else {
  const serial = { requestPort: async () => port, getPorts: async () => [port] };
  Object.defineProperty(navigator, "serial", { value: serial });
}
"""


# With the real service worker, the browser would cache all files for each test.
NO_SERVICE = {"service.js": ""}


class LiveSite:
    """The page at ``url``, and the arm that is plugged in.

    Attributes:
        table: the edition of the next arm.
        instead: the texts of files that replace those of the folder, by name.
        sent: the bytes that the page has written to its port.
        stopped_at: when the last stop was written, by the monotonic clock.
        baudrate: the baud rate with which the port was opened last.
        silent_after: how many further writes the arm replies to; None: to all.
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self.url = folder, ""
        self.table: Table = TABLE
        self.instead = dict(NO_SERVICE)
        self.sent, self.stopped_at, self.baudrate = bytearray(), 0.0, 0
        self.silent_after: int | None = None
        self._sockets: set[ServerConnection] = set()

    @property
    def plugged(self) -> bool:
        """Whether the port is open."""
        return bool(self._sockets)

    def reset(self) -> None:
        """Plug in a new arm, in the state of the first one."""
        self.unplug()
        self.sent, self.table, self.silent_after = bytearray(), TABLE, None
        self.instead = dict(NO_SERVICE)

    def unplug(self) -> None:
        """Let the port disappear."""
        for socket in [*self._sockets]:
            socket.close()

    def answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Serve a file; the page and its worker have a port too."""
        name, _, query = request.path.strip("/").partition("?")
        name = name or "index.html"
        if name == "port":
            self.baudrate = int(query)
            return None
        if name == "slow":
            time.sleep(1.2)
        path = self._folder / name
        if not path.is_file():
            return Response(404, "Not Found", Headers({"Content-Length": "0"}))
        data = self.instead[name].encode() if name in self.instead else path.read_bytes()
        if name in ("source.js", "worker.js"):
            data = PORT.encode() + data
        kind = mimetypes.guess_type(name)[0] or "application/wasm"
        headers = Headers({"Content-Type": kind, "Cache-Control": "no-store"})
        headers["Content-Length"] = str(len(data))
        if name != "index.html":  # which contains the policy
            headers["Content-Security-Policy"] = POLICY
        return Response(200, "OK", headers, data)

    def port(self, socket: ServerConnection) -> None:
        """Forward between the page and an arm, which understands only its own baud rate."""
        understood = self.baudrate == self.table.baudrate
        arm = MemoryTransport(SimulatedArm(self.table, powered=True))
        self._sockets.add(socket)
        threading.Thread(target=_forward, args=(arm, socket), daemon=True).start()
        with suppress(ConnectionClosed):
            for data in socket:
                assert isinstance(data, bytes)
                self.sent += data
                if STOP in data:
                    self.stopped_at = time.monotonic()
                if self.silent_after is not None:
                    self.silent_after -= 1
                if understood and (self.silent_after is None or self.silent_after >= 0):
                    arm.write(data)
        self._sockets.discard(socket)
        arm.close()


def _forward(arm: MemoryTransport, socket: ServerConnection) -> None:
    """Send the page what the arm sends."""
    with suppress(LinkError, ConnectionClosed):
        while True:
            if data := arm.read(60):
                socket.send(data)


@contextmanager
def serving(folder: Path) -> Iterator[LiveSite]:
    """Serve the page and an arm."""
    site = LiveSite(folder)
    with serve(site.port, "127.0.0.1", 0, process_request=site.answer, compression=None) as server:
        site.url = f"http://127.0.0.1:{server.socket.getsockname()[1]}/"
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield site
        site.unplug()
        server.shutdown()
        thread.join(5)
