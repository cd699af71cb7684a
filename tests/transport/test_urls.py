"""Each URL opens its kind of transport, or is rejected."""

from __future__ import annotations

import socket
import subprocess
import sys
import time

import pytest

from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.transport import OpenedTransport, open_transport
from transport.ends import FAST, Line


@pytest.mark.parametrize(
    ("url", "kind", "text"),
    [
        ("hwgrep://nothing-like-this", LinkError, "no ports found"),
        ("/dev/tty\0S0", UsageError, "printable"),
        ("/dev/tty\ud800", UsageError, "printable"),
        ("loop://?x=1", UsageError, "unknown option: 'x'"),
        ("loop://?logging=loud", UsageError, "loud"),
        ("spy:///dev/null?file=/nosuchfolder/f", LinkError, "No such file.*/nosuchfolder/f"),
        ("socket://localhost", UsageError, "host:port"),
        ("socket://localhost:1/path", UsageError, "host:port"),
        ("socket://localhost:1?logging=debug", UsageError, "host:port"),
        ("socket://user@localhost:1", UsageError, "host:port"),
        ("socket://localhost:-1", UsageError, "host:port"),
        ("socket://[::1:9000", UsageError, "host:port"),
        ("socket://no-such-host.invalid:9000", LinkError, "cannot be opened: "),
        (f"socket://{'x' * 70}.example:9000", LinkError, "cannot be opened: "),
        ("socket://127.0.0.1:abc", UsageError, "host:port"),
        ("socket://127.0.0.1:0", UsageError, "host:port"),
        ("socket://127.0.0.1:70000", UsageError, "host:port"),
        ("rfc2217://localhost", UsageError, "host:port"),
        ("socket://127.0.0.1:1", LinkError, "refused"),
        ("alt://x?class=Nope", UsageError, "Nope"),
        ("/dev/null", LinkError, "not a serial port"),
        ("/", LinkError, "Is a directory"),
    ],
)
def test_error_gives_the_reason_why_a_port_cannot_be_opened(
    url: str, kind: type[Exception], text: str
) -> None:
    with pytest.raises(kind, match=text) as caught:
        open_transport(url, FAST)
    assert isinstance(caught.value, UsageError | LinkError)
    assert "[Errno" not in str(caught.value)


def test_ipv6_address_in_brackets_is_accepted() -> None:
    if not socket.has_ipv6:
        pytest.skip("this machine has no IPv6")
    try:
        server = socket.create_server(("::1", 0), family=socket.AF_INET6)
    except OSError:
        pytest.skip("this machine has no IPv6 loopback")
    with server:
        transport = open_transport(f"SOCKET://[::1]:{server.getsockname()[1]}", FAST)
        peer, _ = server.accept()
        with peer:
            peer.sendall(b"six")
            assert transport.read(1.0) == b"six"
        transport.close()


def test_tcp_does_not_wait_to_fill_a_packet() -> None:
    with Line("socket") as line:
        opened = line.transport._socket  # type: ignore[attr-defined]
        assert opened.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) == 1
        assert opened.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
        assert line.transport.low_latency is True


def test_connecting_to_a_silent_host_times_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cobotwire.transport.tcp.CONNECT_SECONDS", 0.2)
    with socket.create_server(("127.0.0.1", 0), backlog=0) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"
        waiting: list[OpenedTransport] = []
        started = time.monotonic()
        # A server that accepts no connection has a queue that is full after a few clients.
        with pytest.raises(LinkError, match=r"cannot be opened: .*timed out"):
            waiting.extend(open_transport(url, FAST) for _ in range(20))
        assert time.monotonic() - started < 5.0
        for transport in waiting:
            transport.close()


def test_tcp_transport_needs_no_pyserial() -> None:
    script = (
        "import sys, socket\n"
        "from cobotwire.transport import open_transport\n"
        "server = socket.create_server(('127.0.0.1', 0))\n"
        "open_transport(f'socket://127.0.0.1:{server.getsockname()[1]}', 115200).close()\n"
        "print('serial' in sys.modules)"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert result.stdout == "False\n"
