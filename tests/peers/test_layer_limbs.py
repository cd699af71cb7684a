"""Replies of a myBuddy that the simulated robot does not give, read by both classes."""

from __future__ import annotations

import pytest

from layer_comparison import layer_on
from pymycobot_classes import peer_on
from pymycobot_ports import ReplyingPort, ReplyingTransport

_WORDS = [1234, -567, 89, 4500, -9000, 17999]


def reply(address: int, command: int, *words: int) -> bytes:
    """Return a frame of the robot with words as its data."""
    data = bytes([command]) + b"".join(word.to_bytes(2, "big", signed=True) for word in words)
    return bytes([0xFE, 0xFE, address, len(data) + 1]) + data + bytes([sum(data) & 0xFF])


@pytest.mark.parametrize(
    ("method", "arguments", "answer"),
    [
        ("get_coord", (1, 1), reply(1, 0x2D, 1234)),
        ("get_coord", (2, 3), reply(2, 0x2D, -1234)),
        ("get_coord", (1, 4), reply(1, 0x2D, 4567)),
        ("get_coord", (3, 1), reply(3, 0x2D, 4567)),
        ("get_coords", (1,), reply(1, 0x23, *_WORDS)),
        ("get_base_coord", (2,), reply(2, 0xF3, *_WORDS)),
        ("get_base_coords", (), reply(0, 0xF4, *_WORDS, *reversed(_WORDS))),
        ("get_base_coords", ([1, 2, 3, 4, 5, 6], 1), reply(0, 0xF0, *_WORDS)),
        ("base_to_single_coords", ([1, 2, 3, 4, 5, 6], 0), reply(0, 0xF1, *_WORDS)),
    ],
)
def test_coordinates_are_read_as_by_the_makers_class(
    method: str, arguments: tuple[object, ...], answer: bytes
) -> None:
    theirs = getattr(peer_on("MyBuddy", ReplyingPort(answer)), method)(*arguments)
    mine = getattr(layer_on("MyBuddy", ReplyingTransport(answer)), method)(*arguments)
    assert theirs not in (None, -1)
    assert mine == theirs
