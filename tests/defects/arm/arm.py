"""An arm in plain Python, written from the document alone: it imports nothing of the package.

It knows the edition ``mycobot`` except motion to coordinates: a run leaves these commands out. A
planted defect replaces methods of an arm.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any

from defects.arm.numbers import ANGLES, COORDS, coords, flange, framed, product, signed, words
from defects.arm.travel import Travel

IDLE = 0.2
# At full speed: a quarter of a turn and half of the gripper's travel in a second.
TICKS_PER_SECOND, PERCENT_PER_SECOND = 1024.0, 50.0
TICKS_PER_DEGREE = 4096 / 360
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


class Arm:
    """The arm: it receives bytes, and returns bytes."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self.clock = clock
        self.buffer, self._at, self.requests = b"", clock(), 0
        # In ticks of the encoders, so that angles and encoders agree exactly.
        self.travel = Travel(clock, [200, -150, 90, 300, -60, 410])
        # In interpolation mode, each target waits for the previous one.
        self._queue: list[tuple[list[int], float]] = []
        self._width, self._width_zero = Travel(clock, [50.0]), 0.0
        self._powered, self._free, self.enabled = True, 0, [1] * 6
        self.limits = {0x4A: [-1650] * 6, 0x4B: [1650] * 6}
        self._registers: dict[tuple[int, int], int] = {}
        # The bytes to send later, with their times; and the state of a planted defect.
        self._due: list[tuple[float, bytes]] = []
        self.memory: dict[str, Any] = {}
        self.reset()

    def reset(self) -> None:
        """Give every setting the value that it has after a power cycle."""
        self.flags = {0x16: 0, 0x85: 0, 0x89: 0}
        self.speed = 50
        self.references = {0x81: bytes(12), 0x83: bytes(12)}
        self._pins: dict[tuple[int, int], int] = {}

    @property
    def wait(self) -> float | None:
        """The seconds until an incomplete request is dropped or bytes are due; None: never."""
        times = [at for at, _ in self._due]
        if self.buffer and (gives_up := self.gives_up()) is not None:
            times.append(gives_up)
        return max(0.0, min(times) - self.clock()) if times else None

    def gives_up(self) -> float | None:
        """Return the time at which an incomplete request is dropped."""
        return self._at + IDLE

    def flush(self) -> bytes:
        """Drop an incomplete request; return the bytes that are due."""
        gives_up, now = self.gives_up(), self.clock()
        if self.buffer and gives_up is not None and now >= gives_up:
            self.lose_state("cut")
            self.buffer = b""
        sent = b"".join(data for at, data in self._due if at <= now)
        self._due = [(at, data) for at, data in self._due if at > now]
        return sent

    def later(self, seconds: float, data: bytes) -> None:
        """Send bytes after some seconds."""
        self._due.append((self.clock() + seconds, data))

    def receive(self, data: bytes) -> bytes:
        """Receive bytes; return the replies."""
        self._at = self.clock()
        self.buffer += data
        sent = b""
        while self.buffer:
            start = self.buffer.find(b"\xfe")
            self.buffer = self.buffer[start:] if start >= 0 else b""
            taken = self.frame(self.buffer)
            if taken is None:
                break
            if taken:
                self.requests += 1
                sent += self.carry_out(taken)
            self.buffer = self.buffer[len(taken) or 1 :]
        return sent

    def frame(self, data: bytes) -> bytes | None:
        """Return the frame at the start; empty if there cannot be one, None if it is incomplete."""
        if data[:2] != b"\xfe\xfe"[: len(data)]:
            return b""
        if len(data) < 4:
            return None
        size = SIZES.get(data[3])
        if size is None or data[2] != size + 2:
            self.lose_state("LEN" if size is not None else "id")
            return b""
        if len(data) < size + 5:
            return None
        if data[size + 4] != 0xFA:
            self.lose_state("footer")
            return b""
        return data[: size + 5]

    def carry_out(self, frame: bytes) -> bytes:
        """Return what is sent in reply to a whole request."""
        return self.reply(frame[3], frame[4:-1])

    def lose_state(self, why: str) -> None:
        """Do nothing: only a planted defect loses state when malformed bytes come."""

    def reply(self, id: int, data: bytes) -> bytes:
        """Return what is sent in reply to a request."""
        if self._queue and not self.travel.moves and not self.travel.held:
            self.travel.go(*self._queue.pop(0))
        if id == 0xB1:
            return b"ssid: MyCobotWiFi2.4G password: mycobot123\r\n"
        if (id in FLAGS and data[0] > 1) or (id in JOINTS and not 1 <= data[0] <= 6):
            return b""
        if (id in OUTPUTS and data[1] > 1) or (id == 0x41 and data[0] > 100):
            return b""
        if (id == 0x53 and not 20 <= data[1] <= 24) or (id == 0x2A and data[12] > 1):
            return b""
        body = self.answer(id, data)
        if body is None:
            self.change(id, data)
            return self.acknowledgement(id)
        return framed(id, body)

    def acknowledgement(self, id: int) -> bytes:
        """Return what is sent after a change: the document defines nothing."""
        return b""

    @property
    def ticks(self) -> list[int]:
        """The positions of the joints."""
        return [round(tick) for tick in self.travel.place()]

    def angles(self) -> list[float]:
        """Return the angles in degrees."""
        return [int(100 * tick * 360 / 4096) / 100 for tick in self.ticks]

    def _encoders(self) -> list[int]:
        return [2048 + sign * tick for sign, tick in zip(SIGNS, self.ticks)]

    def answer(self, id: int, data: bytes) -> bytes | None:
        """Return the data of the reply to a query; None: the request is not a query."""
        joint = data[0] if data else 0
        flags = {0x1B: self._free, 0x86: self.flags[0x85], 0x8A: self.flags[0x89]}
        flags |= {0x12: self._powered, 0x14: 1, 0x51: all(self.enabled), 0x69: self._width.moves}
        flags |= {0x27: self.travel.held, 0x2B: self.travel.moves}
        if id in flags:
            return bytes([flags[id]])
        if id in self.limits:
            return bytes([joint]) + words([self.limits[id][joint - 1]], (1,))
        if id in (0x62, 0xA1):
            return bytes([joint, self._pins.get((id - 1, joint), 0)])
        answers: dict[int, Callable[[], bytes]] = {
            0x20: lambda: words(self.angles(), ANGLES),
            0x23: self._get_coords,
            0x2A: lambda: bytes([self.is_there(data)]),
            0x3B: lambda: struct.pack(">H", self._encoders()[joint - 1]),
            0x3D: lambda: struct.pack(">6H", *self._encoders()),
            0x40: lambda: bytes([self.speed]),
            0x50: lambda: bytes([joint, self.enabled[joint - 1]]),
            0x53: lambda: bytes([self._registers.get((joint, data[1]), 10)]),
            0x65: lambda: bytes(
                [max(0, min(105, round(self._width.place()[0] - self._width_zero)))]
            ),
            0x82: lambda: self.references[0x81],
            0x84: lambda: self.references[0x83],
        }
        return answers[id]() if id in answers else None

    def tool(self) -> list[float]:
        """Return the lengths of the tool in millimetres."""
        return [n / 100 for n in signed(self.references[0x81][:6])]

    def _get_coords(self) -> bytes:
        end = flange(self.angles())
        if self.flags[0x89]:
            moved = [
                [float(row == at) for at in range(3)] + [n] for row, n in enumerate(self.tool())
            ]
            end = product(end, [*moved, [0.0, 0.0, 0.0, 1.0]])
        found = coords(end)
        if self.flags[0x85]:
            found[:3] = [a + b / 100 for a, b in zip(found, signed(self.references[0x83][:6]))]
        return words(found, COORDS)

    def is_there(self, data: bytes) -> bool:
        """Return whether the arm is at a target."""
        scales, near = (COORDS, 5.0) if data[12] else (ANGLES, 0.2)
        here = coords(flange(self.angles())) if data[12] else self.angles()
        target = [n / s for n, s in zip(signed(data[:12]), scales)]
        return all(abs(a - b) <= near for a, b in zip(target, here))

    def change(self, id: int, data: bytes) -> None:
        """Carry out a request that is not a query."""
        moves: dict[int, Callable[[bytes], None]] = {
            0x21: self.send_angle,
            0x22: self._send_angles,
            0x30: lambda data: self.go(self._with(data[0], 9999 if data[1] else -9999), data[2]),
            0x31: self.send_angle,
            0x33: self._step,
            0x3A: lambda data: self.go(self._with(data[0], self._of_encoders(data)), 50),
            0x3C: self._send_encoders,
            0x66: lambda data: self._grip(0 if data[0] else 100, data[1]),
            0x67: lambda data: self._grip(data[0], data[1]),
        }
        if id in (0x11, 0x13, 0x29, 0x34):
            self._queue = []
            self.travel.put(self.travel.place())
        if id in moves:
            if self._powered:
                moves[id](data)
        elif id == 0x26:
            self.travel.hold()
        elif id == 0x28:
            self.travel.resume()
        elif id == 0x68:
            self._width_zero = self._width.place()[0]
        elif id == 0x54:
            self.travel.put([0 if at == data[0] else t for at, t in enumerate(self.ticks, 1)])
        else:
            self._set(id, data)

    def _set(self, id: int, data: bytes) -> None:
        if id in (0x10, 0x11):
            self._powered, self.enabled = id == 0x10, [int(id == 0x10)] * 6
        elif id == 0x13:
            self.enabled = [0] * 6
        elif id in (0x56, 0x57):
            self.enabled[data[0] - 1] = id - 0x56
        elif id == 0x1A:
            self._free = data[0]
        elif id in self.flags:
            self.flags[id] = data[0]
        elif id == 0x41:
            self.speed = data[0]
        elif id in (0x4C, 0x4D):
            self.limits[id - 2][data[0] - 1] = round(signed(data[1:])[0] / 10)
        elif id == 0x52:
            self._registers[data[0], data[1]] = data[2]
        elif id in OUTPUTS:
            self._pins[id, data[0]] = data[1]
        elif id in self.references:
            self.references[id] = data

    def _grip(self, width: float, speed: int) -> None:
        self._width.go([width + self._width_zero], PERCENT_PER_SECOND * max(speed, 1) / 100)

    def go(self, ticks: Sequence[float], speed: int) -> None:
        """Start a motion to a target, clipped to the limits; or queue it during another motion."""
        low, high = (
            [limit / 10 * TICKS_PER_DEGREE for limit in self.limits[id]] for id in (0x4A, 0x4B)
        )
        goal = [min(max(tick, a), b) for tick, a, b in zip(ticks, low, high)]
        target = ([round(tick) for tick in goal], TICKS_PER_SECOND * max(speed, 1) / 100)
        if self.travel.moves and not self.flags[0x16]:
            self._queue.append(target)
        else:
            self._queue = []
            self.travel.go(*target)

    def _with(self, joint: int, tick: float) -> list[float]:
        """Return the positions of all joints, with one of them replaced."""
        return [tick if at == joint else now for at, now in enumerate(self.ticks, 1)]

    def send_angle(self, data: bytes) -> None:
        """Move one joint to an angle."""
        self.go(self._with(data[0], signed(data[1:3])[0] / 100 * TICKS_PER_DEGREE), data[3])

    def _send_angles(self, data: bytes) -> None:
        self.go([n / 100 * TICKS_PER_DEGREE for n in signed(data[:12])], data[12])

    def _step(self, data: bytes) -> None:
        by = signed(data[1:3])[0] / 100 * TICKS_PER_DEGREE
        self.go(self._with(data[0], self.ticks[data[0] - 1] + by), data[3])

    def _of_encoders(self, data: bytes) -> float:
        return (signed(data[1:3])[0] - 2048) * SIGNS[data[0] - 1]

    def _send_encoders(self, data: bytes) -> None:
        self.go([(n - 2048) * sign for n, sign in zip(signed(data[:12]), SIGNS)], data[12])
