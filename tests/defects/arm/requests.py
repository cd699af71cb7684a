"""Planted defects: the arm misreads a request, and so sets or does something else."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import NamedTuple

from conformance.independent.arm import signed


class Misread(NamedTuple):
    """What the arm takes for the data of the request with an id; None: it ignores the request."""

    id: int
    read: Callable[[bytes], bytes | None]


def _packed(words: list[int]) -> bytes:
    return b"".join(struct.pack(">H", n & 0xFFFF) for n in words)


def _words(id: int, change: Callable[[int], int]) -> Misread:
    return Misread(id, lambda data: _packed([change(n) for n in signed(data)]))


def _first(id: int, change: Callable[[int], int]) -> Misread:
    return Misread(id, lambda data: bytes([change(data[0])]) + data[1:])


def _second(id: int, change: Callable[[int], int]) -> Misread:
    return Misread(id, lambda data: data[:1] + bytes([change(data[1])]) + data[2:])


def _swapped(data: bytes) -> bytes:
    words = signed(data)
    words[3], words[4] = words[4], words[3]
    return _packed(words)


MISREAD: dict[str, Misread] = {
    # Settings.
    "speed-100-becomes-99": _first(0x41, lambda speed: min(speed, 99)),
    "speed-0-ignored": Misread(0x41, lambda data: data if data[0] else None),
    "lengths-clipped": _words(0x81, lambda n: max(-3000, min(3000, n))),
    "rounded-to-whole-units": _words(0x83, lambda n: int(n / 100) * 100),
    "rotations-swapped": Misread(0x83, _swapped),
    "sign-lost": _words(0x81, abs),
    "frame-stored-inverted": _first(0x85, lambda frame: 1 - frame),
    "limit-of-the-next-joint": _first(0x4D, lambda joint: joint % 6 + 1),
    "limit-of-joint-3-ignored": Misread(0x4C, lambda data: None if data[0] == 3 else data),
    "pins-modulo-16": _first(0x61, lambda pin: pin % 16),
    "register-off-by-one": _second(0x52, lambda register: min(register + 1, 24)),
    "servo-3-released-for-2": _first(0x56, lambda joint: 3 if joint == 2 else joint),
    # Motion.
    "joint-off-by-one": _first(0x21, lambda joint: joint % 6 + 1),
    "step-in-tenths": Misread(0x33, lambda d: d[:1] + _packed([signed(d[1:3])[0] // 10]) + d[3:]),
    "jog-one-way-only": _second(0x30, lambda direction: 1),
    "opening-inverted": _first(0x67, lambda width: 100 - width),
    "gripper-swaps-open-and-closed": _first(0x66, lambda state: 1 - state),
    "angles-little-endian": Misread(
        0x22, lambda d: b"".join(d[at : at + 2][::-1] for at in range(0, 12, 2)) + d[12:]
    ),
    "speed-of-motion-ignored": Misread(0x22, lambda data: data[:12] + bytes([20])),
}
