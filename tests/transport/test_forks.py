"""A forked child cannot use its parent's transports; if it closes them, the parent keeps them."""

from __future__ import annotations

import asyncio
import gc
import io
import os
import socket
import subprocess
import sys
import threading
import time
import traceback
import warnings
from collections.abc import Callable
from contextlib import suppress

import pytest

from cobotwire import LinkError
from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
from cobotwire.transport import open_transport
from cobotwire.transport.serial.url import UrlTransport
from cobotwire.transport.tapped import TappedTransport
from scripted_peer import PEERS
from transport.ends import FAST, Line, PtyEnd, TcpEnd

KINDS = ["serial", "socket"]
CHILD_SECONDS = 10.0
OPENED_BY = r"process \d+ opened it and then forked this process: open it anew in this one"
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")


def in_child(work: Callable[[], object]) -> str:
    """Run ``work`` in a forked child; return the text of its failure, empty if it passed."""
    reading, writing = os.pipe()
    with warnings.catch_warnings():
        # Python 3.12 warns of a fork in a process with threads, which these tests need.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if not child:
        text = ""
        try:
            work()
        except BaseException:  # the parent reports it
            text = traceback.format_exc()
        os.write(writing, text.encode()[-4000:])
        os._exit(0)
    os.close(writing)
    with open(reading, "rb") as pipe:
        os.set_blocking(reading, False)
        deadline = time.monotonic() + CHILD_SECONDS
        while os.waitpid(child, os.WNOHANG) == (0, 0):
            if time.monotonic() > deadline:
                os.kill(child, 9)
                os.waitpid(child, 0)
                return "the child hangs"
            time.sleep(0.01)
        return (pipe.read() or b"").decode()


def fails_clearly(*calls: Callable[[], object]) -> None:
    """Check that each call raises the error that names the opening process and the remedy."""
    for call in calls:
        with pytest.raises(LinkError, match=OPENED_BY):
            call()


@pytest.mark.parametrize("kind", KINDS)
def test_child_that_closes_the_transport_leaves_it_to_the_parent(kind: str) -> None:
    with Line(kind) as line:

        def use_and_close() -> None:
            transport = line.transport
            fails_clearly(
                lambda: transport.read(0.1),
                lambda: transport.write(b"x"),
                lambda: transport.write_some(b"x"),
                transport.fileno,
            )
            transport.close()
            transport.close()
            fails_clearly(lambda: transport.read(0.1))

        assert in_child(use_and_close) == ""
        used = time.process_time()
        # The parent's read waits without spinning, and bytes arrive in both directions.
        assert line.transport.read(0.3) == b""
        assert time.process_time() - used < 0.1
        line.end.send(b"abc")
        assert line.transport.read(1.0) == b"abc"
        line.transport.write(b"xyz")
        assert line.end.receive(3) == b"xyz"


@pytest.mark.parametrize("kind", KINDS)
def test_long_lived_child_does_not_keep_the_port_locked(kind: str) -> None:
    with Line(kind) as line:
        ending, end = os.pipe()
        started, start = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            child = os.fork()
        if not child:
            os.close(end)
            os.write(start, b"x")
            os.read(ending, 1)
            os._exit(0)
        os.read(started, 1)
        try:
            line.transport.reopen()
            if isinstance(line.end, TcpEnd):
                line.end.hang_up()
                line.end.accept()
            line.end.send(b"abc")
            assert line.transport.read(1.0) == b"abc"
        finally:
            for descriptor in (end, ending, start, started):
                os.close(descriptor)
            os.waitpid(child, 0)


def test_child_may_open_the_transport_anew() -> None:
    with Line("socket") as line:

        def reopen() -> None:
            line.transport.reopen()
            line.transport.write(b"child")
            line.transport.close()

        assert in_child(reopen) == ""
        line.transport.write(b"parent")
        assert line.end.receive(6) == b"parent"
        assert isinstance(line.end, TcpEnd)
        line.end.hang_up()
        line.end.accept()
        assert line.end.receive(5) == b"child"


def test_transport_of_pyserial_is_left_to_the_parent() -> None:
    end = PtyEnd()
    transport = UrlTransport(f"spy://{end.url}", FAST)
    end.accept()

    def use_and_close() -> None:
        fails_clearly(lambda: transport.read(0.1), lambda: transport.write(b"x"))
        transport.close()

    assert in_child(use_and_close) == ""
    end.send(b"abc")
    assert transport.read(1.0) == b"abc"
    transport.close()
    end.unplug()


class ShutsDown(io.RawIOBase):
    """A port that shuts its connection down in all processes when it is closed, as with rfc2217."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection

    def close(self) -> None:
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
            self._socket.close()


def test_port_that_shuts_its_connection_down_stays_open_if_the_child_closes_it() -> None:
    here, there = socket.socketpair()
    transport = UrlTransport("loop://", FAST)
    transport._port.close()
    transport._port = ShutsDown(here)

    def close() -> None:
        transport.close()
        gc.collect()

    assert in_child(close) == ""
    there.sendall(b"abc")
    assert here.recv(3) == b"abc"
    transport.close()
    there.close()


@pytest.mark.parametrize("kind", PEERS)
def test_client_of_the_parent_fails_clearly_in_the_child(kind: str) -> None:
    with PEERS[kind]([ANGLES], [ANGLES]) as peer, MyCobot(peer.url) as arm:
        arm.get_angles()

        def use_and_close() -> None:
            fails_clearly(arm.get_angles, arm.stop, lambda: arm.listen(0.1))
            arm.close()

        assert in_child(use_and_close) == ""
        arm.get_angles()


def test_client_fails_in_the_child_while_a_thread_of_the_parent_is_within_a_call() -> None:
    with PEERS["pty"]() as peer, MyCobot(peer.url, timeout=1.0) as arm:
        steps, transport = arm._connection._steps, arm._connection._transport
        with steps.state, steps.writer.lock, transport._reading:  # type: ignore[attr-defined]
            # Another thread forks; in its child, a thread that does not exist holds these locks.
            results: list[str] = []

            def fork() -> None:
                results.append(in_child(lambda: fails_clearly(arm.get_angles, arm.stop)))

            forking = threading.Thread(target=fork)
            forking.start()
            forking.join()
        assert results == [""]


@pytest.mark.parametrize("threaded", [False, True], ids=["polled", "threaded"])
def test_asyncio_client_of_the_parent_fails_clearly_in_the_child(threaded: bool) -> None:
    with PEERS["tcp"]([ANGLES], [ANGLES]) as peer:
        transport = open_transport(peer.url, FAST)
        # Without a descriptor, threads read and write.
        arm = AsyncMyCobot(WithoutDescriptor(transport, lambda *_: None) if threaded else transport)
        loop = asyncio.new_event_loop()
        loop.run_until_complete(arm.open())
        loop.run_until_complete(arm.get_angles())

        async def use_and_close() -> None:
            for call in (arm.get_angles, arm.stop, lambda: arm.listen(0.1)):
                with pytest.raises(LinkError, match=OPENED_BY):
                    await call()
            await arm.close()

        assert in_child(lambda: asyncio.run(use_and_close())) == ""
        loop.run_until_complete(arm.get_angles())
        loop.run_until_complete(arm.close())
        loop.close()


class WithoutDescriptor(TappedTransport):
    """A transport that no event loop can watch."""

    def fileno(self) -> int | None:
        return None


def test_exit_of_the_child_leaves_the_clients_to_the_parent() -> None:
    # At its exit, the interpreter closes what is still open; this child exits in the usual way.
    program = """
import asyncio, os, sys
from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
arm, other = MyCobot(sys.argv[1]), AsyncMyCobot(sys.argv[2])
loop = asyncio.new_event_loop()
loop.run_until_complete(other.open())
if child := os.fork():
    assert os.waitpid(child, 0)[1] == 0
    arm.get_angles()
    loop.run_until_complete(other.get_angles())
    loop.run_until_complete(other.close())
    arm.close()
    loop.close()
"""
    with PEERS["pty"]([ANGLES]) as first, PEERS["tcp"]([ANGLES]) as second:
        ended = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", program, first.url, second.url],
            capture_output=True,
            text=True,
            timeout=30,
            check=False,
        )
    assert (ended.returncode, ended.stderr) == (0, "")
