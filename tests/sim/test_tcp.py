"""One simulated arm over TCP: several clients, and those that behave badly."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from cobotwire import LinkError, UsageError
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.sim import SimulatedArm, TcpServer
from cobotwire.sim.line import UNREAD_LIMIT
from cobotwire.sim.tcp import MOST_CLIENTS, address

ASK = bytes.fromhex("FE FE 02 12 FA")
OFF = bytes.fromhex("FE FE 03 12 00 FA")


@pytest.fixture
def server() -> Iterator[TcpServer]:
    with TcpServer(SimulatedArm(TABLE)) as serving:
        yield serving


def _connect(server: TcpServer) -> socket.socket:
    client = socket.create_connection(("127.0.0.1", int(server.url.rpartition(":")[2])), 5)
    client.settimeout(5)
    return client


def _comes(right: Callable[[], bool]) -> bool:
    until = time.monotonic() + 30
    while not right() and time.monotonic() < until:
        time.sleep(0.005)
    return right()


def test_it_listens_on_loopback_and_on_a_free_port_unless_told_otherwise(server: TcpServer) -> None:
    assert server.url.startswith("socket://127.0.0.1:")
    assert server.loopback
    with TcpServer(SimulatedArm(TABLE)) as other:
        assert other.url != server.url
    with TcpServer(SimulatedArm(TABLE), "0.0.0.0") as everywhere:
        assert not everywhere.loopback
        with MyCobot280(everywhere.url) as arm:
            assert arm.is_power_on() is False


def test_several_clients_see_one_arm(server: TcpServer) -> None:
    with MyCobot280(server.url) as one, MyCobot280(server.url) as two:
        one.power_on(ack_within=2.0)
        assert two.is_power_on() is True
        one.move_angles([10, 0, 0, 0, 0, 0], 100)
        assert two.get_angles().j1 == pytest.approx(10, abs=0.1)
        assert server.clients == 2
    assert _comes(lambda: server.clients == 0)


def test_each_client_is_answered_what_it_asked_itself(server: TcpServer) -> None:
    right: list[int] = []

    def ask(joint: int) -> None:
        with MyCobot280(server.url, timeout=10) as arm:
            arm.set_servo_data(joint, 21, joint * 10)
            right.extend(arm.get_servo_data(joint, 21) == joint * 10 for _ in range(100))

    threads = [threading.Thread(target=ask, args=[joint]) for joint in range(1, 7)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert right == [True] * 600


def test_halves_of_two_clients_frames_do_not_mix(server: TcpServer) -> None:
    with _connect(server) as one, _connect(server) as two:
        one.sendall(ASK[:3])
        two.sendall(ASK)
        assert two.recv(100) == OFF
        one.sendall(ASK[3:])
        assert one.recv(100) == OFF


def test_the_asyncio_client_drives_it(server: TcpServer) -> None:
    async def drive() -> float:
        async with AsyncMyCobot280(server.url) as arm:
            await arm.power_on()
            await arm.move_angles([5, 0, 0, 0, 0, 0], 100)
            return (await arm.get_angles()).j1

    assert asyncio.run(drive()) == pytest.approx(5, abs=0.1)


def test_a_client_that_goes_within_a_frame_leaves_the_next_one_a_clean_line(
    server: TcpServer,
) -> None:
    with _connect(server) as client:
        client.sendall(ASK[:4])
    with _connect(server) as client:
        client.sendall(ASK)
        assert client.recv(100) == OFF


def test_a_client_that_is_cut_off_hard_is_forgotten(server: TcpServer) -> None:
    with _connect(server) as client:
        client.sendall(ASK * 50)
        # A reset instead of an orderly end, with answers on their way.
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
    assert _comes(lambda: server.clients == 0)
    with MyCobot280(server.url) as arm:
        assert arm.is_power_on() is False


def test_a_client_that_floods_and_never_reads_holds_nobody_up(server: TcpServer) -> None:
    with _connect(server) as flooding, MyCobot280(server.url, timeout=60) as arm:
        stop = threading.Event()

        def flood() -> None:
            flooding.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            while not stop.is_set():
                flooding.sendall(ASK * 400)

        thread = threading.Thread(target=flood)
        thread.start()
        try:
            for _ in range(50):
                assert arm.is_power_on() is False
            assert _comes(lambda: any(c.full for c in tuple(server._channels.values())))
            for channel in tuple(server._channels.values()):
                assert channel.line.unread <= UNREAD_LIMIT + 4096 * 6
        finally:
            stop.set()
            thread.join(60)
    assert not thread.is_alive()


def test_more_clients_than_there_is_room_for_are_sent_away(server: TcpServer) -> None:
    clients = [_connect(server) for _ in range(MOST_CLIENTS)]
    try:
        assert _comes(lambda: server.clients == MOST_CLIENTS)
        with _connect(server) as late:
            assert late.recv(100) == b""
        clients.pop().close()
        assert _comes(lambda: server.clients == MOST_CLIENTS - 1)
        with MyCobot280(server.url) as arm:
            assert arm.is_power_on() is False
    finally:
        for client in clients:
            client.close()


def test_at_the_end_everybody_hears_that_the_arm_is_gone() -> None:
    with TcpServer(SimulatedArm(TABLE)) as server:
        client = _connect(server)
        client.sendall(ASK)
        assert client.recv(100) == OFF
    with client:
        assert client.recv(100) == b""
    with pytest.raises(LinkError):
        MyCobot280(server.url)


def test_a_taken_port_and_a_bad_address_are_refused(server: TcpServer) -> None:
    port = int(server.url.rpartition(":")[2])
    with pytest.raises(LinkError, match=rf"127\.0\.0\.1:{port}: cannot be listened on: Address"):
        TcpServer(SimulatedArm(TABLE), port=port)
    with pytest.raises(LinkError, match=r"no such host\.invalid:0: cannot be listened on"):
        TcpServer(SimulatedArm(TABLE), "no such host.invalid")
    with pytest.raises(UsageError, match="65536"):
        TcpServer(SimulatedArm(TABLE), port=65536)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (":0", ("127.0.0.1", 0)),
        ("localhost:9000", ("localhost", 9000)),
        ("[::1]:80", ("::1", 80)),
    ],
)
def test_addresses(text: str, parts: tuple[str, int]) -> None:
    assert address(text) == parts


@pytest.mark.parametrize("text", ["", "9000", "localhost", "localhost:", "localhost:http", ":-1"])
def test_what_is_no_address(text: str) -> None:
    with pytest.raises(UsageError, match="HOST:PORT"):
        address(text)
