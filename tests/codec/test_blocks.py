"""The native codec reads large streams in blocks of 128 KiB, three positions of each at once.

It finds the same frames as its framer and decoder, even if bytes at a position inside a block look
like the start of another frame.
"""

from __future__ import annotations

from random import Random

import pytest

import vectors
from cobotwire.codec.interface import Listening
from cobotwire.simulator.faults.noise import NOISE
from codec.results import check_against_framer
from strategies import codec_of

INNER = bytes.fromhex("FE FE 03 12 01 FA")
OUTER = bytes.fromhex("FE FE 0E 20") + 2 * INNER + b"\xfa"
LISTENING: list[Listening] = ["request", "reply", "both"]


def stream_of(edition: str, share: float, size: int) -> bytes:
    """Return frames of an edition; a share is damaged, and the same share is preceded by noise."""
    dice, stream = Random(edition), bytearray()
    table = codec_of(edition, "native").table
    frames = [vector.frame for vector in vectors.edition(edition).vectors if vector.frame]
    while len(stream) < size:
        if dice.random() < share:
            noise = NOISE[dice.choice([*NOISE])].draw(dice, table)
            stream += dice.choice([noise, bytes(dice.randrange(600)), b"\xfe" * 40])
        frame = bytearray(dice.choice(frames))
        if dice.random() < share:
            # The result is often still a frame, with other values, legal or not.
            frame[dice.randrange(len(frame))] = dice.randrange(256)
        stream += frame
    return bytes(stream)


@pytest.mark.parametrize("listening", LISTENING)
@pytest.mark.parametrize(
    ("edition", "share", "size"),
    [
        ("mycobot", 0.0, 300_000),
        ("mycobot280", 0.03, 300_000),
        ("mycobot280", 0.6, 150_000),
        ("mybuddy", 0.2, 150_000),
    ],
)
def test_large_stream_has_the_frames_and_noise_of_a_framer(
    edition: str, share: float, size: int, listening: Listening
) -> None:
    stream = stream_of(edition, share, size)
    check_against_framer(codec_of(edition, "native"), listening, stream)


# The second and third lane start at offsets of different parity, so even shifts suffice to try
# every offset within OUTER.
@pytest.mark.parametrize("shift", range(0, len(OUTER), 2))
def test_frames_within_frames_do_not_mislead_the_lanes_of_a_block(shift: int) -> None:
    check_against_framer(codec_of("mycobot", "native"), "reply", bytes(shift) + OUTER * 8_000)


@pytest.mark.parametrize("piece", [b"\xfe", OUTER[:4]], ids=["header bytes", "starts of frames"])
def test_large_stream_without_a_frame_is_one_span_of_noise(piece: bytes) -> None:
    check_against_framer(codec_of("mycobot", "native"), "both", piece * (150_000 // len(piece)))
