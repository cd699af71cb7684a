"""Any number of arms in one process: descriptors above 1024, and few of them for each client."""

from __future__ import annotations

import asyncio
import gc
import resource
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from cobotwire.client.aio_timers import timers_of
from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
from scripted_peer import ScriptedPeer

MANY = 600
FILES_NEEDED = 3 * MANY
FEW = 4
OPEN_FILES = Path("/proc/self/fd")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
MANY_CLIENTS = """
import asyncio, os, resource, sys
from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot

MANY, LIMIT = int(sys.argv[1]), int(sys.argv[2])
resource.setrlimit(resource.RLIMIT_NOFILE, (LIMIT, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
POWERED = bytes.fromhex("FE FE 03 12 01 FA")

class Peer(asyncio.Protocol):
    def connection_made(self, transport):
        self.transport = transport

    def data_received(self, data):
        self.transport.write(POWERED)

async def main():
    loop = asyncio.get_running_loop()
    server = await loop.create_server(Peer, "127.0.0.1", 0, backlog=MANY)
    url = "socket://127.0.0.1:%d" % server.sockets[0].getsockname()[1]
    before = os.dup(0)
    arms = [AsyncMyCobot(url, timeout=30) for _ in range(MANY)]
    for arm in arms:
        await arm.open()
    highest = os.dup(0)
    replies = await asyncio.gather(*(arm.is_power_on() for arm in arms))
    used = len(os.listdir("/proc/self/fd"))
    # The descriptor of this client is a high one, too.
    with_threads = await asyncio.to_thread(blocking, url)
    for arm in arms:
        await arm.close()
    print(sum(replies), highest > 1024, used <= before + 2 * MANY + 8, with_threads)

def blocking(url):
    with MyCobot(url, timeout=30) as arm:
        return arm.is_power_on()

asyncio.run(main())
"""


@pytest.mark.skipif(not OPEN_FILES.is_dir(), reason="counts descriptors as Linux lists them")
def test_600_asyncio_clients_in_one_process_get_their_replies() -> None:
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard != resource.RLIM_INFINITY and hard < FILES_NEEDED:
        pytest.skip(f"this system allows {hard} open files, the test needs {FILES_NEEDED}")
    ended = subprocess.run(
        [sys.executable, "-c", MANY_CLIENTS, str(MANY), str(FILES_NEEDED)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (ended.stderr, ended.stdout) == ("", f"{MANY} True True True\n")


@pytest.mark.skipif(not OPEN_FILES.is_dir(), reason="counts descriptors as Linux lists them")
def test_blocking_client_needs_at_most_one_descriptor_besides_its_port() -> None:
    with _peers() as urls, ExitStack() as stack:
        before = _open_files()
        for url in urls:
            assert stack.enter_context(MyCobot(url)).is_power_on()
        assert _open_files() - before <= 2 * FEW
        stack.close()
        assert _open_files() == before


@pytest.mark.skipif(not OPEN_FILES.is_dir(), reason="counts descriptors as Linux lists them")
def test_asyncio_client_needs_no_descriptor_besides_its_port() -> None:
    async def count(urls: list[str]) -> None:
        # One descriptor is for all arms of the loop.
        timers = timers_of(asyncio.get_running_loop())
        before = _open_files()
        arms = [AsyncMyCobot(url) for url in urls]
        for arm in arms:
            await arm.open()
            assert await arm.is_power_on()
        assert _open_files() - before == FEW
        for arm in arms:
            await arm.close()
        assert _open_files() == before
        del timers

    with _peers() as urls:
        asyncio.run(count(urls))


@contextmanager
def _peers() -> Iterator[list[str]]:
    with ExitStack() as stack:
        yield [stack.enter_context(ScriptedPeer([POWERED])).url for _ in range(FEW)]


def _open_files() -> int:
    """Return how many descriptors are open, after collecting garbage that may hold some."""
    gc.collect()
    return len(list(OPEN_FILES.iterdir()))
