"""URLs: which link they give, and what is refused."""

from __future__ import annotations

import socket
import subprocess
import sys
import time

import pytest

from cobotwire.errors import LinkError, UsageError
from cobotwire.transport import Link, open_link
from transport.ends import FAST, Line


@pytest.mark.parametrize(
    "url",
    [
        "socket://localhost:1/path",
        "socket://localhost:1?logging=debug",
        "socket://user@localhost:1",
        "socket://localhost:-1",
        "socket://[::1:9000",
    ],
)
def test_a_socket_url_is_host_and_port_alone(url: str) -> None:
    with pytest.raises(UsageError, match="host:port"):
        open_link(url, FAST)


def test_a_host_that_nobody_knows_is_told_in_the_systems_words() -> None:
    with pytest.raises(LinkError, match="cannot be opened: ") as caught:
        open_link("socket://no-such-host.invalid:9000", FAST)
    assert "[Errno" not in str(caught.value)


def test_a_host_that_is_no_name_is_a_link_error() -> None:
    with pytest.raises(LinkError, match="cannot be opened"):
        open_link(f"socket://{'x' * 70}.example:9000", FAST)


def test_an_ipv6_address_stands_in_brackets() -> None:
    if not socket.has_ipv6:
        pytest.skip("no IPv6 here")
    try:
        server = socket.create_server(("::1", 0), family=socket.AF_INET6)
    except OSError:
        pytest.skip("no IPv6 loopback here")
    with server:
        link = open_link(f"SOCKET://[::1]:{server.getsockname()[1]}", FAST)
        peer, _ = server.accept()
        with peer:
            peer.sendall(b"six")
            assert link.read(1.0) == b"six"
        link.close()


def test_tcp_does_not_wait_to_fill_a_packet() -> None:
    with Line("socket") as line:
        opened = line.link._socket  # type: ignore[attr-defined]
        assert opened.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) == 1
        assert opened.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
        assert line.link.low_latency is True


def test_a_host_that_does_not_answer_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cobotwire.transport.tcp.CONNECT_SECONDS", 0.2)
    with socket.create_server(("127.0.0.1", 0), backlog=0) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"
        waiting: list[Link] = []
        started = time.monotonic()
        # The queue of a server that accepts nobody is full after a few.
        with pytest.raises(LinkError, match=r"cannot be opened: .*timed out"):
            waiting.extend(open_link(url, FAST) for _ in range(20))
        assert time.monotonic() - started < 5.0
        for link in waiting:
            link.close()


def test_a_tcp_link_needs_no_pyserial() -> None:
    script = (
        "import sys, socket\n"
        "from cobotwire.transport import open_link\n"
        "server = socket.create_server(('127.0.0.1', 0))\n"
        "open_link(f'socket://127.0.0.1:{server.getsockname()[1]}', 115200).close()\n"
        "print('serial' in sys.modules)"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert result.stdout == "False\n"
