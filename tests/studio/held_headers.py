"""Hold connections without the token, and check that pages with it still work."""

from __future__ import annotations

import http.client
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress

from studio.feeds import Feed, watching
from studio.studio_server import Studio

# What each connection sends before it falls silent.
WAYS = {
    "nothing": b"",
    "half a header": b"GET / HTTP/1.1\r\nHost: 127.0.0.1",
    "half a body": b"POST /api/stop HTTP/1.1\r\nHost: 127.0.0.1:PORT\r\nContent-Length: 9\r\n\r\n{",
    "a request, then half a header": b"GET /icon.svg HTTP/1.1\r\nHost: 127.0.0.1:PORT\r\n\r\nGET /",
    "half a WebSocket": b"GET /api/feed HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n",
}
# How long Stop may take: on a page that is open, and over a new connection.
OPEN_SECONDS, NEW_SECONDS = 2.0, 5.0


@contextmanager
def holding(studio: Studio, count: int, way: str) -> Iterator[None]:
    """Hold ``count`` connections; open another one for each that the server closes."""
    sent = WAYS[way].replace(b"PORT", str(studio.port).encode())
    held: list[socket.socket] = []
    ended = threading.Event()

    def hold() -> None:
        while not ended.is_set():
            held[:] = [each for each in held if not _ended(each)]
            held.extend(_opened(studio, sent) for _ in range(count - len(held)))
            ended.wait(0.5)

    held.extend(_opened(studio, sent) for _ in range(count))
    thread = threading.Thread(target=hold)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        for each in held:
            each.close()


def _opened(studio: Studio, sent: bytes) -> socket.socket:
    opened = socket.socket()
    opened.setblocking(False)
    # A full queue of the server must not delay the attack.
    opened.connect_ex(("127.0.0.1", studio.port))
    with suppress(OSError):
        opened.sendall(sent)
    return opened


def _ended(connection: socket.socket) -> bool:
    try:
        while connection.recv(65536):
            pass
    except BlockingIOError:
        return False
    except OSError:
        pass
    connection.close()
    return True


def failure(studio: Studio, count: int, way: str) -> str:
    """Return the first thing that a page with the token cannot do while connections are held."""
    used, new = (http.client.HTTPConnection("127.0.0.1", studio.port, NEW_SECONDS) for _ in "12")
    with watching(studio) as feed, closing(used), closing(new):
        feed.state("hello")
        _stop_by(used, studio)
        with holding(studio, count, way):
            return (
                _tried("Stop of a page that was open", OPEN_SECONDS, lambda: _stop_over(feed))
                or _tried(
                    "Stop over an old connection", OPEN_SECONDS, lambda: _stop_by(used, studio)
                )
                or _tried("Stop over a new connection", NEW_SECONDS, lambda: _stop_by(new, studio))
                or _tried("a new page", NEW_SECONDS, lambda: _open_page(studio))
            )


def _tried(what: str, limit: float, action: Callable[[], None]) -> str:
    start = time.monotonic()
    try:
        action()
    except Exception as error:  # any: each means that the page could not do it
        return f"{what}: {error!r}"
    seconds = time.monotonic() - start
    return f"{what} took {seconds:.1f} s" if seconds > limit else ""


def _stop_over(feed: Feed) -> None:
    feed.wish("stop", number=1)
    assert feed.state("stopped") == {"number": 1, "error": ""}
    # A feed that is never read takes ten seconds to close.
    feed.connection.close()


def _stop_by(connection: http.client.HTTPConnection, studio: Studio) -> None:
    connection.request("POST", "/api/stop", b"{}", studio.own)
    with connection.getresponse() as response:
        assert response.status == 200, response.status
        response.read()


def _open_page(studio: Studio) -> None:
    for path in ("/", "/main.js", "/api/table"):
        status = studio.get(path).status
        assert status == 200, (path, status)
    with watching(studio) as feed:
        feed.state("hello")
        _stop_over(feed)
