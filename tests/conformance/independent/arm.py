"""An arm in plain Python, written from the document alone: it imports nothing of the package.

It knows the settings and queries of the edition ``mycobot``; a motion takes no time. Each defect is
one that a device may have. As a program it serves one client over TCP and prints its port.
"""

from __future__ import annotations

import math
import socket
import struct
import sys
import time
from collections.abc import Callable, Iterable

IDLE = 0.2
# Standard DH: offset and alpha in degrees, a and d in millimetres.
LINKS = (
    (0, 90, 0, 131.22),
    (-90, 0, -110.4, 0),
    (0, 0, -96, 0),
    (-90, 90, 0, 64.62),
    (90, -90, 0, 73.18),
    (0, 0, 0, 48.6),
)
SIGNS = (-1, -1, 1, -1, -1, -1)
# The number of data bytes of each request, by id.
SIZES = {
    **dict.fromkeys((0x10, 0x11, 0x12, 0x13, 0x14, 0x1B, 0x20, 0x23, 0x26, 0x27, 0x28, 0x29), 0),
    **dict.fromkeys((0x2B, 0x34, 0x3D, 0x40, 0x51, 0x65, 0x68, 0x69, 0x82, 0x84, 0x86, 0x8A), 0),
    **dict.fromkeys((0x1A, 0x16, 0x41, 0x3B, 0x4A, 0x4B, 0x50, 0x54, 0x55, 0x56, 0x57), 1),
    **dict.fromkeys((0x62, 0xA1, 0x85, 0x89), 1),
    **dict.fromkeys((0x53, 0x60, 0x61, 0xA0, 0x66, 0x67, 0xB2), 2),
    **dict.fromkeys((0x30, 0x32, 0x3A, 0x4C, 0x4D, 0x52, 0x6A), 3),
    **dict.fromkeys((0x21, 0x24, 0x31, 0x33), 4),
    **dict.fromkeys((0x81, 0x83), 12),
    **dict.fromkeys((0x22, 0x2A, 0x3C), 13),
    0x25: 14,
    0xB1: 0,
}
FLAGS = (0x1A, 0x16, 0x85, 0x89)
OUTPUTS = (0x61, 0xA0)
JOINTS = (0x3B, 0x4A, 0x4B, 0x50, 0x53, 0x4C, 0x4D, 0x52, 0x54, 0x55, 0x56, 0x57, 0x21)


def words(numbers: Iterable[float], scales: Iterable[float]) -> bytes:
    """Return numbers as big-endian words, each times its scale."""
    return b"".join(struct.pack(">H", round(n * s) & 0xFFFF) for n, s in zip(numbers, scales))


def signed(data: bytes) -> list[int]:
    """Return big-endian words; those above 33000 are negative."""
    raws = struct.unpack(f">{len(data) // 2}H", data)
    return [raw - 65536 if raw > 33000 else raw for raw in raws]


COORDS = (10, 10, 10, 100, 100, 100)
ANGLES = (100,) * 6


def product(a: list[list[float]], b: list[list[float]]) -> list[list[float]]:
    """Return the product of two matrices."""
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def flange(angles: Iterable[float]) -> list[list[float]]:
    """Return the flange's frame as a matrix."""
    found = [[float(row == column) for column in range(4)] for row in range(4)]
    for angle, (offset, alpha, a, d) in zip(angles, LINKS):
        t, al = math.radians(angle + offset), math.radians(alpha)
        ct, st, ca, sa = math.cos(t), math.sin(t), math.cos(al), math.sin(al)
        link = [
            [ct, -st * ca, st * sa, a * ct],
            [st, ct * ca, -ct * sa, a * st],
            [0.0, sa, ca, float(d)],
            [0.0, 0.0, 0.0, 1.0],
        ]
        found = product(found, link)
    return found


def coords(m: list[list[float]]) -> list[float]:
    """Return x, y, z, rx, ry, rz of a frame, in millimetres and degrees."""
    ry = math.atan2(-m[2][0], math.hypot(m[0][0], m[1][0]))
    rx, rz = math.atan2(m[2][1], m[2][2]), math.atan2(m[1][0], m[0][0])
    return [m[0][3], m[1][3], m[2][3], *map(math.degrees, (rx, ry, rz))]


class Arm:
    """The arm: bytes in, bytes out. ``defects`` are the names of what is wrong with it."""

    def __init__(self, clock: Callable[[], float] = time.monotonic, *defects: str) -> None:
        self._clock, self._defects = clock, set(defects)
        self._buffer, self._at, self._requests = b"", clock(), 0
        self._stale: bytes = b""
        # In ticks of the encoders, so that angles and encoders agree exactly.
        self._ticks = [200, -150, 90, 300, -60, 410]
        self._powered, self._free, self._enabled = True, 0, [1] * 6
        self._limits = {0x4A: [-1650] * 6, 0x4B: [1650] * 6}
        self._registers: dict[tuple[int, int], int] = {}
        self._port, self._gripper = 9000, 50
        self._reset()

    def _reset(self) -> None:
        """Give every setting the value that it has after a power cycle."""
        self._flags = {0x16: 0, 0x85: 0, 0x89: 0}
        self._speed = 50
        self._references = {0x81: bytes(12), 0x83: bytes(12)}
        self._pins: dict[tuple[int, int], int] = {}

    @property
    def wait(self) -> float | None:
        """Seconds until the arm gives up half a request; None: it has none."""
        return max(0.0, self._at + IDLE - self._clock()) if self._buffer else None

    def flush(self) -> bytes:
        """Give up half a request."""
        if self._buffer and self._clock() >= self._at + IDLE:
            self._lose_state("cut")
            self._buffer = b""
        return b""

    def receive(self, data: bytes) -> bytes:
        """Take bytes; return the replies."""
        self._at = self._clock()
        self._buffer += data
        sent = b""
        while self._buffer:
            start = self._buffer.find(b"\xfe")
            self._buffer = self._buffer[start:] if start >= 0 else b""
            taken = self._frame(self._buffer)
            if taken is None:
                break
            if taken:
                self._requests += 1
                sent += self._reply(taken[3], taken[4:-1])
            self._buffer = self._buffer[len(taken) or 1 :]
        dead = "dies" in self._defects and self._requests > 100
        return b"" if dead else sent

    def _frame(self, data: bytes) -> bytes | None:
        """Return the frame at the start; empty: there is none; None: more bytes may complete it."""
        if data[:2] != b"\xfe\xfe"[: len(data)]:
            return b""
        if len(data) < 4:
            return None
        size = SIZES.get(data[3])
        if size is None or data[2] != size + 2:
            self._lose_state("LEN" if size is not None else "id")
            return b""
        if len(data) < size + 5:
            return None
        if data[size + 4] != 0xFA:
            self._lose_state("footer")
            return b""
        return data[: size + 5]

    def _lose_state(self, why: str) -> None:
        if f"forgets settings after a wrong {why}" in self._defects:
            self._reset()
        if f"forgets the speed after a wrong {why}" in self._defects:
            self._speed = 50

    def _reply(self, id: int, data: bytes) -> bytes:
        if id == 0xB1:
            return b"ssid: MyCobotWiFi2.4G password: mycobot123\r\n"
        if (id in FLAGS and data[0] > 1) or (id in JOINTS and not 1 <= data[0] <= 6):
            return b""
        if (id in OUTPUTS and data[1] > 1) or (id == 0x41 and data[0] > 100):
            return b""
        if (id == 0x53 and not 20 <= data[1] <= 24) or (id == 0x2A and data[12] > 1):
            return b""
        body = self._answer(id, data)
        if body is None:
            self._change(id, data)
            body = b"\x01" if id == 0x6A and "acknowledges the colour" in self._defects else None
        if body is None:
            return b""
        return b"\xfe\xfe" + bytes([len(body) + 2, id]) + body + b"\xfa"

    def _angles(self) -> list[float]:
        return [int(100 * tick * 360 / 4096) / 100 for tick in self._ticks]

    def _encoders(self) -> list[int]:
        return [2048 + sign * tick for sign, tick in zip(SIGNS, self._ticks)]

    def _answer(self, id: int, data: bytes) -> bytes | None:
        """Return the data of the reply to a query; None: it is no query."""
        joint = data[0] if data else 0
        flags = {0x1B: self._free, 0x86: self._flags[0x85], 0x8A: self._flags[0x89]}
        flags |= {0x12: self._powered, 0x14: 1, 0x27: 0, 0x2B: 0, 0x51: all(self._enabled), 0x69: 0}
        if id in flags:
            return bytes([flags[id]])
        scale = 0.1 if "sends limits in degrees" in self._defects else 1
        if id in (0x4A, 0x4B):
            return bytes([joint]) + words([self._limits[id][joint - 1]], (scale,))
        if id in (0x62, 0xA1):
            return bytes([joint, self._pins.get((id - 1, joint), 0)])
        answers: dict[int, Callable[[], bytes]] = {
            0x20: self._get_angles,
            0x23: self._get_coords,
            0x2A: lambda: bytes([self._is_there(data)]),
            0x3B: lambda: struct.pack(">H", self._encoders()[joint - 1]),
            0x3D: lambda: struct.pack(">6H", *self._encoders()),
            0x40: lambda: bytes([self._speed]),
            0x50: lambda: bytes([joint, self._enabled[joint - 1]]),
            0x53: lambda: bytes([self._registers.get((joint, data[1]), 10)]),
            0x65: lambda: bytes([self._gripper]),
            0x82: lambda: self._references[0x81],
            0x84: lambda: self._references[0x83],
        }
        return answers[id]() if id in answers else None

    def _get_angles(self) -> bytes:
        angles = self._angles()
        if "swaps joints 1 and 2" in self._defects:
            angles[:2] = angles[1::-1]
        scale = 10 if "sends angles in tenths" in self._defects else 100
        sent = words(angles, (scale,) * 6)
        if "replies with the angles before" in self._defects:
            sent, self._stale = self._stale or sent, sent
        return sent

    def _get_coords(self) -> bytes:
        end = flange(self._angles())
        x, y, z = (n / 100 for n in signed(self._references[0x81][:6]))
        if "takes the tool in tenths of its length" in self._defects:
            x, y, z = x / 10, y / 10, z / 10
        if "swaps the axes of the tool" in self._defects:
            x, y = y, x
        if self._flags[0x89]:
            move = [
                [1.0, 0.0, 0.0, x],
                [0.0, 1.0, 0.0, y],
                [0.0, 0.0, 1.0, z],
                [0.0, 0.0, 0.0, 1.0],
            ]
            end = product(end, move)
        found = coords(end)
        if self._flags[0x85]:
            world = signed(self._references[0x83][:6])
            found[:3] = [a + b / 100 for a, b in zip(found, world)]
        return words(
            found,
            (100 if "sends coordinates in hundredths" in self._defects else 10,) * 3 + (100,) * 3,
        )

    def _is_there(self, data: bytes) -> bool:
        scales, here = (COORDS, coords(flange(self._angles()))) if data[12] else (ANGLES, None)
        target = [n / s for n, s in zip(signed(data[:12]), scales)]
        near = 5.0 if data[12] else 0.2
        return all(abs(a - b) <= near for a, b in zip(target, here or self._angles()))

    def _change(self, id: int, data: bytes) -> None:
        if id in (0x10, 0x11):
            self._powered, self._enabled = id == 0x10, [int(id == 0x10)] * 6
        elif id == 0x13:
            self._enabled = [0] * 6
        elif id in (0x56, 0x57):
            self._enabled[data[0] - 1] = id - 0x56
        elif id == 0x1A:
            self._free = data[0]
        elif id in self._flags:
            self._flags[id] = data[0]
        elif id == 0x41:
            self._speed = data[0]
        elif id in (0x4C, 0x4D):
            self._limits[id - 2][data[0] - 1] = round(signed(data[1:])[0] / 10)
        elif id == 0x52:
            self._registers[data[0], data[1]] = data[2]
        elif id in (0x61, 0xA0):
            self._pins[id, data[0]] = data[1]
        elif id in self._references:
            self._references[id] = data
        elif id == 0x22:
            self._ticks = [round(n / 100 * 4096 / 360) for n in signed(data[:12])]
        elif id == 0x67:
            self._gripper = data[0]


def serve(*defects: str) -> None:
    """Serve one client on a free port of this computer, and print the port."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        print(server.getsockname()[1], flush=True)
        client, _ = server.accept()
        client.settimeout(IDLE)
        arm = Arm(time.monotonic, *defects)
        while True:
            try:
                data = client.recv(4096)
                if not data:
                    return
                client.sendall(arm.receive(data))
            except TimeoutError:
                arm.flush()


if __name__ == "__main__":
    serve(*sys.argv[1:])
