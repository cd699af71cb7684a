"""A client in plain Python, from the document alone. It makes the calls of ``calls.txt``.

    python plain.py PORT [DEFECT]

It connects to a port of this computer. Queries are sent again if nothing comes for 170 ms, at most
twice; everything else is sent once. Each defect is one that a client may have.
"""

from __future__ import annotations

import contextlib
import math
import socket
import struct
import sys
import time
from collections.abc import Sequence

PATIENCE, ATTEMPTS, BETWEEN = 0.17, 3, 0.004
# How many times two queries are sent at the end, alternately.
ROUNDS = 8
# A late reply may come up to this many seconds after its request.
LATEST = 0.75
POSE, STEEP = (10, -20.5, 33.33, -45, 60, -70.07), -33.3
PLACE = (160.5, -80.2, 210.7, -170, 10.5, 30)
TOOL = (1.5, -20, 30, 4, -5, 60)
# The scales of coordinates, and of angles and references.
COORDS, HUNDREDTHS = (10, 10, 10, 100, 100, 100), (100,) * 6
QUERIES = {0x12, 0x20, 0x23, 0x2B, 0x3B, 0x40}


class Client:
    """The client; ``defect`` is the name of what is wrong with it."""

    def __init__(self, line: socket.socket, defect: str = "") -> None:
        self._line, self._defect = line, defect
        self._received = b""
        # By id: the queries that were sent again, and the time until which a late reply may come.
        self._doubtful: dict[int, tuple[bytes, float]] = {}

    def run(self) -> None:
        """Make all calls."""
        wrong = self._defect
        self.call(0x10)
        self.call(0x12)
        self.call(0x41, bytes([40]))
        self.call(0x20)
        self.call(0x22, self.words(self.pose(), HUNDREDTHS) + bytes([self.speed(40)]))
        self.call(0x2B)
        joint = 4 if wrong == "joint-off-by-one" else 3
        angle = struct.pack(">h", self.rounded(STEEP * 100))
        self.call(0x21, bytes([joint]) + angle + bytes([40]))
        self.call(0x23)
        mode = 0 if wrong == "wrong-mode" else 1
        self.call(0x25, self.words(PLACE, COORDS) + bytes([30, mode]))
        self.call(0x81, self.words(self.tool(), HUNDREDTHS))
        self.call(0x3B, bytes([5]))
        self.call(0x3B, bytes([4]))
        self.call(0x66, bytes([int(wrong == "open-is-1"), 50]))
        colour = bytes([10, 20, 30])
        self.call(0x6A, colour[::-1] if wrong == "blue-first" else colour)
        self.call(0x33, bytes([2]) + struct.pack(">h", -550) + bytes([30]))
        if wrong != "stop-never-sent":
            self.call(0x29)
        if wrong == "extra-query":
            self.call(0x40)
        self.call(0x61, bytes([6 if wrong == "pin-off-by-one" else 5, 1]))
        if wrong == "moves-after-release":
            self.call(0x13)
        if wrong == "moves-after-power-off":
            self.call(0x11)
        self.call(0x21, bytes([1]) + struct.pack(">h", 0) + bytes([20]))
        for _ in range(ROUNDS):
            self.call(0x20)
            self.call(0x2B)
        if wrong == "last-frame-cut":
            self._line.sendall(b"\xfe\xfe\x02")
        else:
            self.call(0x11)

    def pose(self) -> Sequence[float]:
        """Return the angles of the pose."""
        if self._defect == "radians":
            return [math.radians(angle) for angle in POSE]
        if self._defect == "one-angle-tenfold":
            return (POSE[0], POSE[1] * 10, *POSE[2:])
        return POSE[::-1] if self._defect == "joints-in-reverse" else POSE

    def speed(self, wanted: int) -> int:
        """Return a speed in percent."""
        others = {"speed-off-by-one": wanted + 1, "speed-out-of-range": 120}
        return others.get(self._defect, wanted)

    def tool(self) -> Sequence[float]:
        """Return the tool's reference."""
        if self._defect == "x-and-y-swapped":
            return (TOOL[1], TOOL[0], *TOOL[2:])
        return [abs(n) for n in TOOL] if self._defect == "sign-lost" else TOOL

    def rounded(self, number: float) -> int:
        """Return the nearest whole number."""
        return int(number) if self._defect == "truncates" else round(number)

    def words(self, numbers: Sequence[float], scales: Sequence[int]) -> bytes:
        """Return numbers as words, each times its scale."""
        form = "<h" if self._defect == "little-endian" else ">h"
        return b"".join(struct.pack(form, round(n * s)) for n, s in zip(numbers, scales))

    def frame(self, id: int, body: bytes) -> bytes:
        """Return a frame."""
        wrong = self._defect
        if wrong == "unknown-id" and id == 0x6A:
            id = 0x9A
        size = len(body) + (3 if wrong == "len-one-too-large" and id == 0x20 else 2)
        header = b"\xfe" if wrong == "short-header" and id == 0x23 else b"\xfe\xfe"
        end = b"" if wrong == "no-footer" and id == 0x2B else b"\xfa"
        end = b"\xfb" if wrong == "wrong-footer" and id == 0x41 else end
        end += b"\r\n" if wrong == "line-ends" else b""
        return header + bytes([size, id]) + body + end

    def call(self, id: int, body: bytes = b"") -> None:
        """Send a request, and wait for its reply if it has one."""
        data = self.frame(id, body)
        if id not in QUERIES:
            self.change(id, data)
            return
        self.await_late_replies(id, data)
        attempts = 1 if self._defect == "stops-when-a-reply-is-lost" else ATTEMPTS
        for _ in range(attempts):
            self.send(data)
            if self._defect == "does-not-wait" or self.replied(id):
                return
            self._doubtful[id] = (data, time.monotonic() + LATEST)
        if self._defect == "stops-when-a-reply-is-lost":
            raise TimeoutError(f"no reply to {id:02X}")

    def await_late_replies(self, id: int, data: bytes) -> None:
        """Wait while a late reply to an earlier query with this id could be taken for the reply."""
        earlier, until = self._doubtful.pop(id, (data, 0.0))
        if earlier != data:
            time.sleep(max(0.0, until - time.monotonic()))

    def change(self, id: int, data: bytes) -> None:
        """Send a request that changes something."""
        wrong = self._defect
        if wrong == "frame-in-two-writes" and id == 0x22:
            self._line.sendall(data[:7])
            time.sleep(0.4)
            data = data[7:]
        if wrong == "writes-into-a-frame" and id == 0x25:
            data = data[:9] + self.frame(0x29, b"") + data[9:]
        self.send(data)
        if (wrong == "steps-sent-twice" and id == 0x33) or wrong == "changes-sent-thrice":
            for _ in range(1 if id == 0x33 else 2):
                time.sleep(0.1)
                self.send(data)
        time.sleep(BETWEEN)

    def send(self, data: bytes) -> None:
        """Drop what has been received so far, and send bytes."""
        self._line.setblocking(False)
        with contextlib.suppress(BlockingIOError):
            while self._line.recv(4096):
                pass
        self._line.setblocking(True)
        self._received = b""
        self._line.sendall(data)

    def replied(self, id: int) -> bool:
        """Wait for the reply to a query."""
        hasty = self._defect == "repeats-after-3-ms"
        until = time.monotonic() + (0.003 if hasty else PATIENCE)
        while (left := until - time.monotonic()) > 0:
            self._line.settimeout(left)
            try:
                self._received += self._line.recv(4096)
            except TimeoutError:
                return False
            finally:
                self._line.settimeout(None)
            if self._defect == "takes-text-for-the-reply" or self.holds_reply(id):
                return True
        return False

    def holds_reply(self, id: int) -> bool:
        """Return whether a whole reply has been received."""
        at = self._received.find(b"\xfe\xfe")
        while at >= 0:
            part = self._received[at:]
            whole = len(part) > 4 and len(part) >= part[2] + 3 and part[part[2] + 2] == 0xFA
            if whole and (part[3] == id or self._defect == "takes-any-frame-for-the-reply"):
                return True
            at = self._received.find(b"\xfe\xfe", at + 1)
        return False


if __name__ == "__main__":
    with socket.create_connection(("127.0.0.1", int(sys.argv[1]))) as connected:
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        Client(connected, *sys.argv[2:]).run()
