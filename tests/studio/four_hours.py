"""Show four hours of traffic at 50 Hz, faster than real time; memory must not grow.

    python -m studio.four_hours [HOURS]

A page in Chromium watches, and another one never reads. Exits with 1 if memory grows.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import socket
import sys
import threading
import time
from collections import deque
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import uvicorn
from starlette.applications import Starlette

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec.interface import Noise
from cobotwire.editions import mycobot280
from cobotwire.editions.mycobot280 import Angles, GetAngles, GetAnglesReply
from cobotwire.session import Traffic, UnexpectedFrame
from cobotwire.simulator import SimulatedArm, TcpServer
from cobotwire.studio.accepting import Server
from cobotwire.studio.access import Access
from cobotwire.studio.app import make_app
from cobotwire.studio.arm_line import ArmLine, PortOptions
from cobotwire.studio.connections import Connections
from cobotwire.studio.live import LiveSession
from cobotwire.studio.sending import Control
from cobotwire.studio.stage import Stage
from studio.driven_page import Page, browser

HERTZ = 50
# Each time the server takes traffic, it gets this many seconds of it.
SECONDS_A_TIME = 2.5
NOISE_EVERY = 100
NOISE = b"ets Jun  8 2016 00:22:57\r\n"
REPORTS = 8
# The first part fills the bounded buffers. After that, growth up to this size is noise: several
# batches for slow pages may exist at once, each of up to 3 MB.
FILLED = 3
GROWTH, BATCHES_MB = 1.15, 10.0


class FastLine(ArmLine):
    """Traffic of an arm that is polled at 50 Hz, on a fast clock; the codec makes the frames."""

    seconds = 0.0

    def take(self) -> list[Traffic]:
        """Return the traffic of the next seconds."""
        if not hasattr(self, "_made"):
            self._made = self._traffic_of_hours()
        until = self.seconds + SECONDS_A_TIME
        taken = []
        while self.seconds < until:
            taken.append(next(self._made))
        return taken

    def _traffic_of_hours(self) -> Iterator[Traffic]:
        codec = codecs.load(self.table)
        framer, start = codec.framer("reply"), time.monotonic()
        request = codec.encode("get_angles", "request", GetAngles().values)
        for number in itertools.count():
            self.seconds = number / HERTZ
            at = start + self.seconds
            yield Traffic(at, "sent", request)
            angles = [(number % 9000) / 100 + joint for joint in range(6)]
            reply = codec.encode("get_angles", "reply", GetAnglesReply(Angles(*angles)).values)
            noise = NOISE if number % NOISE_EVERY == 0 else b""
            for event in framer.feed(noise + reply):
                what = event if isinstance(event, Noise) else UnexpectedFrame(event)
                yield Traffic(at + 0.008, "received", event.data, what)


@contextmanager
def serving() -> Iterator[tuple[FastLine, LiveSession, Access]]:
    """Serve a studio with such traffic."""
    edition = editions.load("mycobot280")
    arm = SimulatedArm(mycobot280.TABLE)
    with TcpServer(arm.connect) as simulated, socket.create_server(("127.0.0.1", 0)) as listening:
        line = FastLine(edition, PortOptions(simulated.url), 0.0)
        session = LiveSession(line, deque())
        access = Access("127.0.0.1", listening.getsockname()[1])

        @asynccontextmanager
        async def lifespan(app: Starlette) -> AsyncIterator[None]:
            task = asyncio.create_task(session.pump())
            yield
            task.cancel()

        connections = Connections()
        app = make_app(Stage(edition, session, Control(False)), access, connections, lifespan)
        config = uvicorn.Config(
            app, ws="websockets-sansio", ws_per_message_deflate=False, log_level="error"
        )
        server = Server(config, listening, connections)
        thread = threading.Thread(target=server.run)
        thread.start()
        try:
            yield line, session, access
        finally:
            server.should_exit = True
            thread.join(10)


@contextmanager
def stalled(access: Access) -> Iterator[None]:
    """Open a feed, and never read from it."""
    with socket.create_connection(("127.0.0.1", access.port)) as raw:
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        lines = (
            "GET /api/feed HTTP/1.1",
            f"Host: 127.0.0.1:{access.port}",
            f"Origin: http://127.0.0.1:{access.port}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
            f"Sec-WebSocket-Protocol: cobotwire-studio, token.{access.token}",
        )
        raw.sendall("\r\n".join([*lines, "", ""]).encode())
        yield


def resident() -> float:
    """Return the memory of this process, the server, in megabytes."""
    words = Path("/proc/self/status").read_text().split()
    return int(words[words.index("VmRSS:") + 1]) / 1024


def heap(page: Page) -> float:
    """Return the memory of the page's scripts in megabytes."""
    page.tab.call("HeapProfiler.collectGarbage")
    return float(page.tab.call("Runtime.getHeapUsage")["usedSize"]) / 2**20


def main() -> None:
    """Measure the memory of server and page; exit with 1 if it grows."""
    hours = float(sys.argv[1]) if len(sys.argv) > 1 else 4.0
    grown = False
    with serving() as (line, session, access), browser() as page, stalled(access):
        page.show()
        page.open(access.url)
        first: tuple[float, float] = 0.0, 0.0
        for report in range(1, REPORTS + 1):
            while line.seconds < report / REPORTS * hours * 3600:
                time.sleep(0.5)
            page.tab.events.clear()
            now = resident(), heap(page)
            first = now if report == FILLED else first
            lost = sum(viewer.lost for viewer in session.viewers.values())
            shown = page.text("line-count")
            print(
                f"{line.seconds / 3600:4.1f} h  {session.history.count:>8} entries  "
                f"server {now[0]:6.1f} MB  page {now[1]:5.1f} MB  "
                f"{lost} lost by slow pages  page: {shown}",
                flush=True,
            )
            if report > FILLED:
                grown |= any(new > GROWTH * old + BATCHES_MB for new, old in zip(now, first))
    print(json.dumps({"grown": grown}))
    sys.exit(grown)


if __name__ == "__main__":
    main()
