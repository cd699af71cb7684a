"""The others on the speed bench: memcpy, a textbook decoder, NumPy, pymycobot."""

from __future__ import annotations

import itertools
import struct
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any
from unittest import mock

import numpy as np

from readers import pymycobot_peer

# What a careful person writes: a table of unpackers by id and LEN.
WORDS = struct.Struct(">6h")
ANGLES, COORDS = 0x20, 0x23


def memcpy(data: bytes) -> Callable[[], object]:
    """Copies the input into memory that is there."""
    source = np.frombuffer(data, np.uint8)
    target = np.empty_like(source)
    return lambda: np.copyto(target, source)


def find_and_struct(data: bytes) -> list[tuple[int, int, Any]]:
    """The frames of ``data`` by ``bytes.find``, decoded by ``struct``: offset, id and values."""
    found: list[tuple[int, int, Any]] = []
    at = data.find(b"\xfe\xfe")
    size = len(data)
    while at >= 0 and at + 4 < size:
        length = data[at + 2]
        end = at + 3 + length
        if 2 <= length <= 26 and end <= size and data[end - 1] == 0xFA:
            id = data[at + 3]
            values: Any
            if id == ANGLES and length == 14:
                values = tuple([word / 100 for word in WORDS.unpack_from(data, at + 4)])
            elif id == COORDS and length == 14:
                x, y, z, rx, ry, rz = WORDS.unpack_from(data, at + 4)
                values = (x / 10, y / 10, z / 10, rx / 100, ry / 100, rz / 100)
            else:
                values = tuple(data[at + 4 : end - 1])
            found.append((at, id, values))
            at = data.find(b"\xfe\xfe", end)
        else:
            at = data.find(b"\xfe\xfe", at + 1)
    return found


def numpy_columns(data: bytes) -> dict[int, tuple[Any, Any]]:
    """A vectorised scan: offsets and float64 values of angles and coordinates, by id.

    It takes each place where header, LEN and footer fit for a frame, and so is right only where no
    frame holds what looks like one; it does not look at any other message.
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


def pymycobot_reads(data: bytes) -> Callable[[], list[Any]]:
    """Pymycobot's own ``_read`` and ``_process_received``, frame after frame, from memory.

    Its port gives a byte a call, as its code asks for, and its clock stands still.
    """
    common, peer = pymycobot_peer()
    clock = SimpleNamespace(time=lambda: 0.0)

    def read() -> list[Any]:
        line = iter([data[at : at + 1] for at in range(len(data))])
        peer._serial_port = SimpleNamespace(read=partial(next, line, b""))
        found = []
        with mock.patch.object(common, "time", clock):
            for _ in itertools.count():
                try:
                    frame = peer._read(0x20)
                except struct.error:
                    break
                if not frame:
                    break
                found.append(_pymycobot_values(peer, frame))
        return found

    return read


def _pymycobot_values(peer: Any, frame: Any) -> Any:
    id = frame[3]
    try:
        words = peer._process_received(frame, id)
    except struct.error:
        return None  # its users meet this error: some short replies are shorter than it expects
    if id == ANGLES:
        return [peer._int2angle(word) for word in words]
    if id == COORDS:
        return [peer._int2coord(w) for w in words[:3]] + [peer._int2angle(w) for w in words[3:]]
    return words


def struct_send_angles(angles: list[float], speed: int) -> bytes:
    """A frame by ``struct`` and ``round``, unchecked."""
    words = [round(angle * 100) for angle in angles]
    return struct.pack(">4B6hBB", 0xFE, 0xFE, 15, 0x22, *words, speed, 0xFA)


def pymycobot_send_angles(angles: list[float], speed: int) -> Callable[[], list[int]]:
    """Pymycobot's building of the frame: its conversion, ``_mesg`` and ``_flatten``; no port."""
    _, peer = pymycobot_peer()
    from pymycobot import MyCobot280
    from pymycobot.common import ProtocolCode

    def build() -> list[int]:
        words = [peer._angle2int(angle) for angle in angles]
        command, _, _ = super(MyCobot280, peer)._mesg(ProtocolCode.SEND_ANGLES, words, speed)
        flat: list[int] = peer._flatten(command)
        return flat

    return build
