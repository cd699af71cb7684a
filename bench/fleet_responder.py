"""Answer for a fleet of arms on one TCP port: each connection is an arm.

The simulator computes motion and takes some 100 us for a request. That is too slow for a thousand
arms at 20 Hz in one process. So this process compares each request with one frame, and replies with
another: ``python fleet_responder.py REQUEST REPLY``, both in hex. It prints its port.
"""

from __future__ import annotations

import select
import socket
import sys
from contextlib import suppress

from descriptor_limit import raise_limit

BACKLOG = 4096
EVENTS = 1024


def main() -> None:
    """Accept connections and reply, until the process is killed."""
    request, reply = map(bytes.fromhex, sys.argv[1:])
    raise_limit()
    server = socket.create_server(("127.0.0.1", 0), backlog=BACKLOG)
    server.setblocking(False)
    print(server.getsockname()[1], flush=True)
    poll = select.epoll()
    poll.register(server, select.EPOLLIN)
    arms: dict[int, socket.socket] = {}
    while True:
        for descriptor, _ in poll.poll(maxevents=EVENTS):
            if descriptor == server.fileno():
                arm, _ = server.accept()
                arm.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                arms[arm.fileno()] = arm
                poll.register(arm, select.EPOLLIN)
                continue
            arm = arms[descriptor]
            received = b""
            # The client may have ended with replies unread, or while one is sent.
            with suppress(ConnectionError):
                received = arm.recv(4096)
                for _ in range(received.count(request)):
                    arm.send(reply)
            if not received:
                del arms[descriptor]
                arm.close()


if __name__ == "__main__":
    main()
