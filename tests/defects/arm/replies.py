"""Planted defects: one command's reply has wrong bytes."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import NamedTuple

from conformance.independent.arm import signed


class WrongReply(NamedTuple):
    """What happens to the reply of the command with an id; ``data`` is that of the request."""

    id: int
    spoil: Callable[[bytes, bytes], bytes]


def framed(id: int, body: bytes) -> bytes:
    """Return a frame with the right LEN."""
    return b"\xfe\xfe" + bytes([len(body) + 2, id]) + body + b"\xfa"


def _body(id: int, change: Callable[[bytes], bytes]) -> WrongReply:
    """Return a defect that changes only the data of a reply."""
    return WrongReply(id, lambda data, sent: framed(id, change(sent[4:-1])) if sent else sent)


def _words(id: int, change: Callable[[list[int]], list[int]]) -> WrongReply:
    """Return a defect that changes the signed words of a reply."""

    def changed(body: bytes) -> bytes:
        return b"".join(struct.pack(">H", n & 0xFFFF) for n in change(signed(body)))

    return _body(id, changed)


def _swapped(first: int, second: int) -> Callable[[list[int]], list[int]]:
    def swap(words: list[int]) -> list[int]:
        words[first], words[second] = words[second], words[first]
        return words

    return swap


def _sign_and_magnitude(words: list[int]) -> list[int]:
    return [0x8000 | -n if n < 0 else n for n in words]


def _radians(words: list[int]) -> list[int]:
    return [*words[:3], *(round(math.radians(n)) for n in words[3:])]


def _in_sequence(bodies: dict[bytes, bytes]) -> Callable[[bytes, bytes], bytes]:
    """Return a function that sends the reply to the request before, of the same command."""

    def spoil(data: bytes, sent: bytes) -> bytes:
        before = bodies.get(b"", sent)
        bodies[b""] = sent
        return before

    return spoil


def wrong_replies() -> dict[str, WrongReply]:
    """Return the defects by the name of their switch."""
    return {
        # Frames.
        "len-one-too-large": WrongReply(0x20, lambda _, s: s[:2] + bytes([s[2] + 1]) + s[3:]),
        "len-of-whole-frame": WrongReply(0x3D, lambda _, s: s[:2] + bytes([len(s)]) + s[3:]),
        "one-byte-short": _body(0x23, lambda body: body[:-1]),
        "one-byte-long": _body(0x82, lambda body: body + b"\x00"),
        "wrong-footer": WrongReply(0x40, lambda _, s: s[:-1] + b"\xfb"),
        "wrong-header": WrongReply(0x3B, lambda _, s: b"\xfe\xfd" + s[2:]),
        "wrong-id": WrongReply(0x12, lambda _, s: s[:3] + b"\x10" + s[4:]),
        "no-reply": WrongReply(0x14, lambda _, s: b""),
        "no-reply-for-the-last-joint": _nothing_for(0x4B, 6),
        "wrong-joint-echoed": _body(0x50, lambda body: bytes([body[0] % 6 + 1]) + body[1:]),
        # Values.
        "little-endian": _words(0x3D, lambda ws: [((n & 255) << 8) | ((n >> 8) & 255) for n in ws]),
        "sign-and-magnitude": _words(0x20, _sign_and_magnitude),
        "tenths-of-degrees": _words(0x20, lambda words: [round(n / 10) for n in words]),
        "hundredths-of-millimetres": _words(0x23, lambda ws: [n * 10 for n in ws[:3]] + ws[3:]),
        "rotation-in-radians": _words(0x23, _radians),
        "joints-in-reverse": _words(0x3D, lambda words: words[::-1]),
        "two-joints-swapped": _words(0x20, _swapped(3, 4)),
        "encoder-of-one-joint-off": _words(0x3D, lambda ws: [*ws[:2], ws[2] + 100, *ws[3:]]),
        "y-mirrored": _words(0x23, lambda words: [words[0], -words[1], *words[2:]]),
        "limit-in-hundredths": _body(0x4A, _times_ten),
        "flag-is-255": _body(0x51, lambda body: b"\xff" if body == b"\x01" else body),
        "flag-inverted": _body(0x86, lambda body: bytes([1 - body[0]])),
        "opening-out-of-range": _body(0x65, lambda body: bytes([body[0] * 255 // 100])),
        "one-register-wrong": _second(0x53, 22, lambda body: bytes([body[0] ^ 1])),
        # Memory.
        "reply-of-the-request-before": WrongReply(0x3B, _in_sequence({})),
    }


def _nothing_for(id: int, part: int) -> WrongReply:
    return WrongReply(id, lambda data, sent: b"" if data[0] == part else sent)


def _times_ten(body: bytes) -> bytes:
    return body[:1] + struct.pack(">H", (signed(body[1:])[0] * 10) & 0xFFFF)


def _second(id: int, wanted: int, change: Callable[[bytes], bytes]) -> WrongReply:
    def spoil(data: bytes, sent: bytes) -> bytes:
        return framed(id, change(sent[4:-1])) if sent and data[1] == wanted else sent

    return WrongReply(id, spoil)
