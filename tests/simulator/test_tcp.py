"""Test one simulated arm over TCP, with several clients; some of them misbehave."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest

from cobotwire import LinkError, UsageError
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import SimulatedArm, TcpServer
from cobotwire.simulator.client_connection import UNREAD_LIMIT
from cobotwire.simulator.tcp import IDLE_SECONDS, MOST_CLIENTS, address

QUERY = bytes.fromhex("FE FE 02 12 FA")
OFF = bytes.fromhex("FE FE 03 12 00 FA")


@pytest.fixture
def server() -> Iterator[TcpServer]:
    with TcpServer(SimulatedArm(TABLE).connect) as serving:
        yield serving


def _connect(server: TcpServer) -> socket.socket:
    client = socket.create_connection(("127.0.0.1", int(server.url.rpartition(":")[2])), 5)
    client.settimeout(5)
    return client


def _comes(right: Callable[[], bool]) -> bool:
    # On a loaded machine the server needs half a minute to fill the system's buffers.
    until = time.monotonic() + 120
    while not right() and time.monotonic() < until:
        time.sleep(0.005)
    return right()


def test_tcp_server_listens_on_loopback_and_a_free_port_by_default(server: TcpServer) -> None:
    assert server.url.startswith("socket://127.0.0.1:")
    assert server.loopback
    with TcpServer(SimulatedArm(TABLE).connect) as other:
        assert other.url != server.url
    with TcpServer(SimulatedArm(TABLE).connect, "0.0.0.0") as everywhere:
        assert not everywhere.loopback
        with MyCobot280(everywhere.url) as arm:
            assert arm.is_power_on() is False


def test_each_client_gets_the_replies_to_its_own_requests(server: TcpServer) -> None:
    right: list[int] = []

    def query(joint: int) -> None:
        with MyCobot280(server.url, timeout=10) as arm:
            arm.set_servo_data(joint, 21, joint * 10)
            right.extend(arm.get_servo_data(joint, 21) == joint * 10 for _ in range(100))

    threads = [threading.Thread(target=query, args=[joint]) for joint in range(1, 7)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert right == [True] * 600


def test_client_with_a_reset_connection_is_dropped(server: TcpServer) -> None:
    with _connect(server) as client:
        client.sendall(QUERY * 50)
        # A reset instead of an orderly end, with replies on their way.
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
    assert _comes(lambda: server.clients == 0)
    with MyCobot280(server.url) as arm:
        assert arm.is_power_on() is False


def test_client_that_floods_and_never_reads_does_not_block_others(server: TcpServer) -> None:
    # Connections inherit the size. Filling the default buffers of megabytes would take too long.
    server._listening.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
    with _connect(server) as flooding, MyCobot280(server.url, timeout=60) as arm:
        stop = threading.Event()

        def flood() -> None:
            flooding.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            while not stop.is_set():
                flooding.sendall(QUERY * 400)

        thread = threading.Thread(target=flood)
        thread.start()
        try:
            for _ in range(50):
                assert arm.is_power_on() is False
            assert _comes(lambda: any(c.full for c in tuple(server._clients.values())))
            for client in tuple(server._clients.values()):
                assert client.connection.unread <= UNREAD_LIMIT + 4096 * 6
            assert arm.is_power_on() is False
        finally:
            stop.set()
            thread.join(60)
    assert not thread.is_alive()


def test_clients_beyond_the_limit_are_disconnected(server: TcpServer) -> None:
    clients = [_connect(server) for _ in range(MOST_CLIENTS)]
    try:
        assert _comes(lambda: server.clients == MOST_CLIENTS)
        for client in clients:
            client.sendall(QUERY)
            assert client.recv(100) == OFF
        with _connect(server) as late:
            assert late.recv(100) == b""
        clients.pop().close()
        assert _comes(lambda: server.clients == MOST_CLIENTS - 1)
        with MyCobot280(server.url) as arm:
            assert arm.is_power_on() is False
    finally:
        for client in clients:
            client.close()


def test_client_that_is_idle_for_longest_makes_room_for_a_new_one(server: TcpServer) -> None:
    with ExitStack() as stack:
        clients = [stack.enter_context(_connect(server)) for _ in range(MOST_CLIENTS)]
        assert _comes(lambda: server.clients == MOST_CLIENTS)
        # Only the first and the last client send anything.
        for _ in range(2):
            clients[0].sendall(QUERY)
            assert clients[0].recv(100) == OFF
            time.sleep(IDLE_SECONDS / 2 + 0.2)
        for busy in (clients[0], clients[-1]):
            busy.sendall(QUERY)
            assert busy.recv(100) == OFF
        for number in range(1, MOST_CLIENTS - 1):
            late = stack.enter_context(_connect(server))
            late.sendall(QUERY)
            assert late.recv(100) == OFF
            assert clients[number].recv(100) == b""
        for busy in (clients[0], clients[-1]):
            busy.sendall(QUERY)
            assert busy.recv(100) == OFF


def test_server_without_descriptors_waits_and_then_accepts() -> None:
    # In another process, whose limit of open files is low.
    program = """
import resource, sys, time
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import SimulatedArm, TcpServer
with TcpServer(SimulatedArm(TABLE).connect) as server:
    held = [open("/dev/null") for _ in range(8)]
    resource.setrlimit(resource.RLIMIT_NOFILE, (held[-1].fileno() + 1, 4096))
    print(server.url, flush=True)
    sys.stdin.readline()
    print(time.process_time(), flush=True)
    sys.stdin.readline()
    print(time.process_time(), flush=True)
    held.clear()
    sys.stdin.readline()
"""
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None

        def processor_time() -> float:
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdin.write("\n")
            process.stdin.flush()
            return float(process.stdout.readline())

        url = process.stdout.readline().strip()
        with socket.create_connection(("127.0.0.1", int(url.rpartition(":")[2])), 5) as client:
            client.settimeout(5)
            client.sendall(QUERY)
            started = processor_time()
            time.sleep(1.0)
            assert processor_time() - started < 0.3
            # A file was closed meanwhile.
            assert client.recv(100) == OFF
        process.communicate("\n", timeout=10)
        assert process.returncode == 0


def test_closing_the_server_disconnects_all_clients() -> None:
    with TcpServer(SimulatedArm(TABLE).connect) as server:
        client = _connect(server)
        client.sendall(QUERY)
        assert client.recv(100) == OFF
    with client:
        assert client.recv(100) == b""
    with pytest.raises(LinkError):
        MyCobot280(server.url)


def test_port_in_use_and_bad_address_raise_errors(server: TcpServer) -> None:
    port = int(server.url.rpartition(":")[2])
    with pytest.raises(LinkError, match=rf"127\.0\.0\.1:{port}: cannot listen: Address"):
        TcpServer(SimulatedArm(TABLE).connect, port=port)
    with pytest.raises(LinkError, match=r"no such host\.invalid:0: cannot listen"):
        TcpServer(SimulatedArm(TABLE).connect, "no such host.invalid")
    with pytest.raises(UsageError, match="65536"):
        TcpServer(SimulatedArm(TABLE).connect, port=65536)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (":0", ("127.0.0.1", 0)),
        ("localhost:9000", ("localhost", 9000)),
        ("[::1]:80", ("::1", 80)),
    ],
)
def test_address_is_split_into_host_and_port(text: str, parts: tuple[str, int]) -> None:
    assert address(text) == parts


@pytest.mark.parametrize("text", ["", "9000", "localhost", "localhost:", "localhost:http", ":-1"])
def test_text_that_is_not_an_address_is_rejected(text: str) -> None:
    with pytest.raises(UsageError, match="HOST:PORT"):
        address(text)
