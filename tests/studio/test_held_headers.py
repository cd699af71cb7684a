"""Hold connections open without the token: pages with it must continue, and new ones must open."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from functools import partial
from random import Random

import pytest

from cobotwire.studio.connections import (
    MOST_KNOWN,
    MOST_OF_ONE_HOST,
    MOST_UNKNOWN,
    Connection,
    Connections,
)
from studio.held_headers import WAYS, failure
from studio.studio_server import Studio, running

FILES = "import resource; resource.setrlimit(resource.RLIMIT_NOFILE, ({0}, {0})); "
CHANGED = "from cobotwire.studio import accepting, connections, gate; "
NO_LIMIT = "connections.MOST_UNKNOWN = connections.MOST_OF_ONE_HOST = 10**9; "
# Servers that are broken on purpose; each with what a page can no longer do.
DEFECTS = {
    "the newest is closed": (
        CHANGED + "connections.attrgetter = lambda name: lambda each: -each.since",
        "Stop over a new connection",
    ),
    "the token protects nothing": (
        CHANGED + "connections.MOST_KNOWN = 0",
        "Stop over an old connection",
    ),
    "no limit": (
        FILES.format(80) + CHANGED + NO_LIMIT + "connections.Connections.make_room = id",
        "Stop over a new connection",
    ),
}


@pytest.fixture(scope="module")
def studio() -> Iterator[Studio]:
    with running("--allow-motion", "--rate", "5") as server:
        yield server


# A stall of the machine would add to the time of four requests and a feed, one after another.
@pytest.mark.stall(0.1)
@pytest.mark.parametrize("way", WAYS)
def test_page_stops_the_arm_and_another_opens_while_connections_are_held(
    studio: Studio, way: str
) -> None:
    assert failure(studio, 300, way) == ""


def test_thousands_of_held_connections_delay_no_page(studio: Studio) -> None:
    assert failure(studio, 1500, "half a header") == ""


def test_process_that_may_open_few_files_serves_pages_and_logs_no_traceback() -> None:
    with running("--allow-motion", "--rate", "5", first=FILES.format(80)) as studio:
        assert failure(studio, 600, "half a header") == ""
    assert studio.log == [""]


@pytest.mark.parametrize("defect", DEFECTS)
def test_attack_shows_a_planted_defect(defect: str) -> None:
    first, lost = DEFECTS[defect]
    with running("--allow-motion", "--rate", "5", first=first) as studio:
        assert failure(studio, 300, "half a header").startswith(lost)


def test_connection_whose_headers_never_end_is_closed() -> None:
    first = CHANGED + "connections.HEADER_SECONDS = accepting.SWEEP_SECONDS = 0.3"
    with running(first=first) as studio:
        lines = (f"{name}: {value}" for name, value in studio.own.items())
        host = f"Host: 127.0.0.1:{studio.port}"
        own = "\r\n".join(["GET /api/table HTTP/1.1", host, *lines, "", ""]).encode()
        for request in (b"", own):
            with socket.create_connection(("127.0.0.1", studio.port), 20) as raw:
                raw.sendall(request)
                assert not request or raw.recv(12).endswith(b" 200")
                raw.sendall(b"GET / HTTP/1.1\r\nA: ")
                began = time.monotonic()
                while not _closed(raw):
                    assert time.monotonic() < began + 5
                    time.sleep(0.05)


def _closed(raw: socket.socket) -> bool:
    """Send one more byte of the header; return whether the connection is closed."""
    try:
        raw.sendall(b"x")
    except OSError:
        return True
    return False


def test_only_connections_without_the_token_are_closed() -> None:
    for seed in range(50):
        draw, connections = Random(seed), Connections()
        opened: list[Connection] = []
        closed: set[Connection] = set()
        hosts = [f"10.0.0.{number}" for number in range(draw.choice((1, 2, 5)))]
        for _ in range(250):
            opened.append(new := Connection(draw.choice(hosts), lambda: None))
            new.abort = partial(closed.add, new)
            connections.arrive(new)
            if draw.random() < 0.3:
                connections.begin(new, known=draw.random() < 0.5)
            if draw.random() < 0.2:
                connections.end(new)
            assert new not in closed
            assert sum(not each.known and each not in closed for each in opened) <= MOST_UNKNOWN
        assert not any(each.known for each in closed)
        assert sum(each.known for each in opened) <= MOST_KNOWN


def test_one_host_closes_no_connection_of_another() -> None:
    connections, closed = Connections(), list[str]()
    for _ in range(MOST_UNKNOWN - MOST_OF_ONE_HOST):
        connections.arrive(Connection("10.0.0.1", lambda: closed.append("other")))
    for _ in range(1000):
        connections.arrive(Connection("10.0.0.2", lambda: closed.append("own")))
    assert closed == ["own"] * (1000 - MOST_OF_ONE_HOST)
