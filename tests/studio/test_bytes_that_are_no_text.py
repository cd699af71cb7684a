"""Send bytes that are not UTF-8 wherever a page sends text: no traceback is logged."""

from __future__ import annotations

import socket
import struct

from studio.studio_server import Studio, running

BAD = (
    *(b"\xff", b"\xc3(", b"\xed\xa0\x80", b"\x80", b"\xf5\x80\x80\x80", b"%FF", b"%C3%28"),
    *(b"\x00", b"%00", b"9" * 5000),
)
END = b"Connection: close\r\n\r\n"
UPGRADE = (
    b"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
)
# Messages in frames with an empty mask: the first byte of each frame, and its content.
MESSAGES = {
    "text": [(0x81, b"\xff")],
    "text in two frames": [(0x01, b"\xc3"), (0x80, b"(")],
    "surrogate": [(0x81, b"\xed\xa0\x80")],
    "reason of a close": [(0x88, b"\x03\xe8\xff")],
}


def _requests(studio: Studio, bad: bytes) -> dict[str, bytes]:
    host = f"Host: 127.0.0.1:{studio.port}\r\n".encode()
    own = host + "".join(f"{name}: {value}\r\n" for name, value in studio.own.items()).encode()
    table, post = b"GET /api/table HTTP/1.1\r\n", b"POST /api/send HTTP/1.1\r\n"
    feed = b"GET /api/feed HTTP/1.1\r\n" + UPGRADE
    return {
        "path": b"GET /" + bad + b" HTTP/1.1\r\n" + own + END,
        "number": b"GET /api/entry/" + bad + b" HTTP/1.1\r\n" + own + END,
        "query": b"GET /api/export?format=" + bad + b" HTTP/1.1\r\n" + own + END,
        "method": b"G" + bad + b" /api/table HTTP/1.1\r\n" + own + END,
        "host": table + b"Host: 127.0.0.1:" + bad + b"\r\n" + END,
        "name of a header": table + own + b"X" + bad + b": 1\r\n" + END,
        "page": table + own + b"X-Studio-Page: " + bad + b"\r\n" + END,
        "token": table + host + b"Authorization: Bearer " + bad + b"\r\n" + END,
        "length": post + own + b"Content-Length: " + bad + b"\r\n" + END,
        "body": post + own + b"Content-Length: %d\r\n" % len(bad) + END + bad,
        "token of a WebSocket": feed + own + b"Sec-WebSocket-Protocol: token." + bad + b"\r\n\r\n",
        "path of a WebSocket": feed.replace(b"feed", b"feed" + bad) + own + b"\r\n",
        "key of a WebSocket": feed.replace(b"AA==", bad) + own + b"\r\n",
    }


def test_bytes_that_are_not_text_are_answered_and_log_no_traceback() -> None:
    with running() as studio:
        for bad in BAD:
            for place, request in _requests(studio, bad).items():
                with socket.create_connection(("127.0.0.1", studio.port), 20) as raw:
                    raw.sendall(request)
                    status = raw.makefile("rb").readline()
                # A request is not refused for a value that the server does not use.
                assert status.split()[1].startswith((b"4", b"200")), (place, bad[:9], status)
        lines = {**studio.own, "Host": f"127.0.0.1:{studio.port}"}
        lines["Sec-WebSocket-Protocol"] = f"cobotwire-studio, token.{studio.token}"
        headers = "".join(f"{name}: {value}\r\n" for name, value in lines.items()).encode()
        for message in MESSAGES.values():
            with socket.create_connection(("127.0.0.1", studio.port), 20) as raw:
                raw.sendall(b"GET /api/feed HTTP/1.1\r\n" + UPGRADE + headers + b"\r\n")
                received = raw.makefile("rb")
                assert received.readline().split()[1] == b"101"
                for first, content in message:
                    raw.sendall(struct.pack("!BBI", first, 0x80 | len(content), 0) + content)
                # 1007: the content of the message does not match its type.
                assert b"\x03\xef" in received.read()[-60:]
    # A line for each message that is not valid text; requests log nothing.
    assert len(studio.log[0].splitlines()) == 3, studio.log[0]
    assert "Traceback" not in studio.log[0]
