"""The peers of the speed bench: memcpy, a textbook decoder, NumPy, pymycobot."""

from __future__ import annotations

import os
import struct
import tty
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import serial

from cobotwire.protocol.table import Table
from readers import pymycobot_peer

ANGLES, COORDS = 0x20, 0x23


def memcpy(data: bytes) -> Callable[[], object]:
    """Return a function that copies the input into allocated memory."""
    source = np.frombuffer(data, np.uint8)
    target = np.empty_like(source)
    return lambda: np.copyto(target, source)


class Found(NamedTuple):
    """A message that the textbook decoder found."""

    offset: int
    name: str
    values: tuple[float, ...]


class FindDecoder:
    """A careful decoder in plain Python: ``bytes.find`` and ``struct`` over a kept buffer.

    It knows the replies by id and LEN, keeps incomplete frames, and continues at the next byte if
    a candidate fails.
    """

    def __init__(self, table: Table) -> None:
        self.buffer = b""
        self.offset = 0
        self.kinds: dict[tuple[int, int], tuple[str, struct.Struct, list[float]]] = {}
        for command in table.commands:
            for variant in command.reply:
                numbers = [n for part in variant.fields for n in part.cases[0].numbers]
                codes = "".join({1: "B", 2: "h", 4: "i"}[number.width] for number in numbers)
                key = command.id, table.frame.length(variant.size)
                scales = [number.steps(1.0) for number in numbers]
                self.kinds.setdefault(key, (command.name, struct.Struct(">" + codes), scales))

    def feed(self, data: bytes) -> list[Found]:
        """Take bytes and return the messages in them."""
        data = self.buffer + data
        found = []
        at = data.find(b"\xfe\xfe")
        size = len(data)
        while at >= 0 and at + 4 < size:
            end = at + 3 + data[at + 2]
            kind = self.kinds.get((data[at + 3], data[at + 2]))
            if kind is None or (end <= size and data[end - 1] != 0xFA):
                at = data.find(b"\xfe\xfe", at + 1)
                continue
            if end > size:
                break
            name, unpacker, scales = kind
            words = unpacker.unpack_from(data, at + 4)
            values = tuple([word / scale for word, scale in zip(words, scales)])
            found.append(Found(self.offset + at, name, values))
            at = data.find(b"\xfe\xfe", end)
        keep = at if at >= 0 else size - data.endswith(b"\xfe")
        self.offset += keep
        self.buffer = data[keep:]
        return found


def numpy_columns(data: bytes) -> dict[int, tuple[Any, Any]]:
    """Return offsets and float64 values of angles and coordinates by id, from a vectorised scan.

    It accepts each position with a fitting header, LEN and footer as a frame. So its result is
    correct only if no frame contains bytes that look like one. It ignores all other messages.
    """
    bytes_ = np.frombuffer(data, np.uint8)
    starts = np.flatnonzero((bytes_[:-16] == 0xFE) & (bytes_[1:-15] == 0xFE))
    whole = (bytes_[starts + 2] == 14) & (bytes_[starts + 16] == 0xFA)
    starts = starts[whole]
    ids = bytes_[starts + 3]
    found = {}
    for id, scale in [(ANGLES, [100.0] * 6), (COORDS, [10.0] * 3 + [100.0] * 3)]:
        mine = starts[ids == id]
        rows = bytes_[mine[:, None] + np.arange(4, 16)]
        words = rows.reshape(-1, 6, 2).view(">i2")[:, :, 0]
        found[id] = mine, words / np.array(scale)
    return found


def pymycobot_reads(data: bytes, starts: Sequence[int]) -> Callable[[], list[Any]]:
    """Return pymycobot's ``_read`` and ``_process_received`` on pyserial, as its users run them.

    The port is a pseudo-terminal. One system call fills it before each 100 frames, so that no read
    waits.
    """
    _, peer = pymycobot_peer()
    master, slave = os.openpty()
    tty.setraw(slave)
    peer._serial_port = serial.Serial(os.ttyname(slave), 1_000_000, timeout=0.1)
    cuts = [*starts[::100], len(data)]
    pieces = [data[a:b] for a, b in pairwise(cuts)]

    def read() -> list[Any]:
        found = []
        for place, piece in enumerate(pieces):
            os.write(master, piece)
            for _ in starts[100 * place : 100 * place + 100]:
                found.append(_pymycobot_values(peer, peer._read(0x20)))
        return found

    return read


def _pymycobot_values(peer: Any, frame: Any) -> Any:
    id = frame[3]
    try:
        words = peer._process_received(frame, id)
    except struct.error:
        return None  # its users see this error: some replies are shorter than it expects
    if id == ANGLES:
        return [peer._int2angle(word) for word in words]
    if id == COORDS:
        return [peer._int2coord(w) for w in words[:3]] + [peer._int2angle(w) for w in words[3:]]
    return words


def six_floats(angles: list[float]) -> Callable[[], object]:
    """Return a function that creates the objects of one frame: a list, two tuples, six floats."""
    data, unpack = struct.pack("=6d", *angles), struct.Struct("=6d").unpack
    return lambda: [(unpack(data),)]


def struct_send_angles(angles: list[float], speed: int) -> bytes:
    """Build a frame with ``struct`` and ``round``, without checks."""
    words = [round(angle * 100) for angle in angles]
    return struct.pack(">4B6hBB", 0xFE, 0xFE, 15, 0x22, *words, speed, 0xFA)


def pymycobot_send_angles(angles: list[float], speed: int) -> Callable[[], list[int]]:
    """Return pymycobot's frame builder: its conversion, ``_mesg`` and ``_flatten``, no port."""
    _, peer = pymycobot_peer()
    from pymycobot import MyCobot280
    from pymycobot.common import ProtocolCode

    def build() -> list[int]:
        words = [peer._angle2int(angle) for angle in angles]
        command, _, _ = super(MyCobot280, peer)._mesg(ProtocolCode.SEND_ANGLES, words, speed)
        flat: list[int] = peer._flatten(command)
        return flat

    return build
