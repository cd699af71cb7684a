"""Planted defects: one command's reply has wrong bytes, or one command's request is misread.

A defect replaces methods of an arm by functions, which take the arm, the correct method, and its
arguments.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from defects.arm.arm import Arm
from defects.arm.numbers import framed, packed, signed

Right = Callable[..., Any]
Hook = Callable[..., Any]
Defect = dict[str, Hook]


def spoilt(wanted: int, spoil: Callable[[Arm, bytes, bytes], bytes]) -> Defect:
    """Change the reply to one command; ``spoil`` takes the request's data and the right reply."""

    def reply(arm: Arm, right: Right, id: int, data: bytes) -> bytes:
        sent: bytes = right(id, data)
        return spoil(arm, data, sent) if id == wanted and sent else sent

    return {"reply": reply}


def _bytes(id: int, change: Callable[[bytes], bytes]) -> Defect:
    return spoilt(id, lambda arm, data, sent: change(sent))


def _body(id: int, change: Callable[[bytes], bytes]) -> Defect:
    """Change only the data of a reply."""
    return _bytes(id, lambda sent: framed(id, change(sent[4:-1])))


def _words(id: int, change: Callable[[list[int]], list[int]]) -> Defect:
    """Change the signed words of a reply."""
    return _body(id, lambda body: packed(change(signed(body))))


def swapped(first: int, second: int) -> Callable[[list[Any]], list[Any]]:
    """Return a function that swaps two numbers of a list."""

    def swap(words: list[Any]) -> list[Any]:
        words[first], words[second] = words[second], words[first]
        return words

    return swap


def _request_before(arm: Arm, data: bytes, sent: bytes) -> bytes:
    before: bytes = arm.memory.get("before", sent)
    arm.memory["before"] = sent
    return before


# Replies with wrong bytes.
REPLIES: dict[str, Defect] = {
    "len-one-too-large": _bytes(0x20, lambda s: s[:2] + bytes([s[2] + 1]) + s[3:]),
    "len-of-whole-frame": _bytes(0x3D, lambda s: s[:2] + bytes([len(s)]) + s[3:]),
    "one-byte-short": _body(0x23, lambda body: body[:-1]),
    "one-byte-long": _body(0x82, lambda body: body + b"\x00"),
    "wrong-footer": _bytes(0x40, lambda sent: sent[:-1] + b"\xfb"),
    "wrong-header": _bytes(0x3B, lambda sent: b"\xfe\xfd" + sent[2:]),
    "wrong-id": _bytes(0x12, lambda sent: sent[:3] + b"\x10" + sent[4:]),
    "no-reply": _bytes(0x14, lambda sent: b""),
    "no-reply-for-the-last-joint": spoilt(0x4B, lambda _, d, sent: b"" if d[0] == 6 else sent),
    "wrong-joint-echoed": _body(0x50, lambda body: bytes([body[0] % 6 + 1]) + body[1:]),
    "little-endian": _words(0x3D, lambda ws: [((n & 255) << 8) | ((n >> 8) & 255) for n in ws]),
    "sign-and-magnitude": _words(0x20, lambda ws: [0x8000 | -n if n < 0 else n for n in ws]),
    "tenths-of-degrees": _words(0x20, lambda words: [round(n / 10) for n in words]),
    "hundredths-of-millimetres": _words(0x23, lambda ws: [n * 10 for n in ws[:3]] + ws[3:]),
    "rotation-in-radians": _words(
        0x23, lambda words: [*words[:3], *(round(math.radians(n)) for n in words[3:])]
    ),
    "joints-in-reverse": _words(0x3D, lambda words: words[::-1]),
    "two-joints-swapped": _words(0x20, swapped(3, 4)),
    "encoder-of-one-joint-off": _words(0x3D, lambda ws: [*ws[:2], ws[2] + 100, *ws[3:]]),
    "y-mirrored": _words(0x23, lambda words: [words[0], -words[1], *words[2:]]),
    "limit-in-hundredths": _body(
        0x4A, lambda body: body[:1] + packed(n * 10 for n in signed(body[1:]))
    ),
    "flag-is-255": _body(0x51, lambda body: b"\xff" if body == b"\x01" else body),
    "flag-inverted": _body(0x86, lambda body: bytes([1 - body[0]])),
    "opening-out-of-range": _body(0x65, lambda body: bytes([body[0] * 255 // 100])),
    "one-register-wrong": spoilt(
        0x53, lambda _, d, sent: framed(0x53, bytes([sent[4] ^ 1])) if d[1] == 22 else sent
    ),
    "reply-of-the-request-before": spoilt(0x3B, _request_before),
}


def misread(wanted: int, read: Callable[[bytes], bytes | None]) -> Defect:
    """Replace the data of a request; None: ignore the request."""

    def change(arm: Arm, right: Right, id: int, data: bytes) -> None:
        taken = read(data) if id == wanted else data
        if taken is not None:
            right(id, taken)

    return {"change": change}


def _each(id: int, change: Callable[[int], int]) -> Defect:
    """Misread each word of a request."""
    return misread(id, lambda data: packed(change(n) for n in signed(data)))


def _byte(at: int, id: int, change: Callable[[int], int]) -> Defect:
    """Misread one byte of a request."""
    return misread(id, lambda data: data[:at] + bytes([change(data[at])]) + data[at + 1 :])


def _low_byte_first(data: bytes) -> bytes:
    return b"".join(data[at : at + 2][::-1] for at in range(0, 12, 2)) + data[12:]


# Requests that are misread, so that the arm sets or does something else.
REQUESTS: dict[str, Defect] = {
    "speed-100-becomes-99": _byte(0, 0x41, lambda speed: min(speed, 99)),
    "speed-0-ignored": misread(0x41, lambda data: data if data[0] else None),
    "lengths-clipped": _each(0x81, lambda n: max(-3000, min(3000, n))),
    "rounded-to-whole-units": _each(0x83, lambda n: int(n / 100) * 100),
    "rotations-swapped": misread(0x83, lambda data: packed(swapped(3, 4)(signed(data)))),
    "sign-lost": _each(0x81, abs),
    "frame-stored-inverted": _byte(0, 0x85, lambda frame: 1 - frame),
    "limit-of-the-next-joint": _byte(0, 0x4D, lambda joint: joint % 6 + 1),
    "limit-of-joint-3-ignored": misread(0x4C, lambda data: None if data[0] == 3 else data),
    "pins-modulo-16": _byte(0, 0x61, lambda pin: pin % 16),
    "register-off-by-one": _byte(1, 0x52, lambda register: min(register + 1, 24)),
    "servo-3-released-for-2": _byte(0, 0x56, lambda joint: 3 if joint == 2 else joint),
    "joint-off-by-one": _byte(0, 0x21, lambda joint: joint % 6 + 1),
    "step-in-tenths": misread(
        0x33, lambda data: data[:1] + packed([signed(data[1:3])[0] // 10]) + data[3:]
    ),
    "jog-one-way-only": _byte(1, 0x30, lambda direction: 1),
    "opening-inverted": _byte(0, 0x67, lambda width: 100 - width),
    "gripper-swaps-open-and-closed": _byte(0, 0x66, lambda state: 1 - state),
    "angles-little-endian": misread(0x22, _low_byte_first),
    "speed-of-motion-ignored": misread(0x22, lambda data: data[:12] + bytes([20])),
}
