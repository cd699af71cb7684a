"""Strategies for the bytes of real lines: noise, damaged frames and undamaged frames.

The simulator's faults make the noise and the damage; Hypothesis makes their random choices.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from hypothesis import strategies as st

from cobotwire.protocol.table import Table
from cobotwire.simulator.faults import Corrupted, Dropped, Noise, Truncated
from cobotwire.simulator.faults.fault import Damage
from cobotwire.simulator.faults.noise import NOISE
from cobotwire.simulator.faults.stream import damaged

# An undamaged frame, one after noise that looks like a header, a damaged one, and noise alone.
KINDS = st.lists(
    st.sampled_from(["frame", "frame after a tail", "damaged", "noise"]), min_size=1, max_size=9
)
DAMAGE: st.SearchStrategy[Damage] = st.sampled_from(
    [
        Dropped(),
        Corrupted(),
        Truncated(),
        Noise(classes=("byte",), where="inside"),
        Noise(where="inside"),
    ]
)
# Hypothesis draws the random numbers, so that failing examples shrink.
DRAWS = st.randoms(use_true_random=False)


class Received(NamedTuple):
    """The bytes that arrive, and each frame that arrives undamaged, with its offset."""

    data: bytes
    whole: list[tuple[int, bytes]]


def noise_of(table: Table, *classes: str) -> st.SearchStrategy[bytes]:
    """Draw pieces of these classes of the catalogue; without names, of all classes."""
    names = st.sampled_from(classes or tuple(NOISE))
    return st.builds(lambda name, random: NOISE[name].draw(random, table), names, DRAWS)


@lru_cache
def line_noise(table: Table) -> st.SearchStrategy[bytes]:
    """Draw realistic noise: pieces of the catalogue, some cut, and any bytes."""
    pieces = noise_of(table)
    return st.one_of(
        pieces,
        st.builds(lambda piece, cut: piece[cut:], pieces, st.integers(0, 20)),
        st.integers(1, 300).map(bytes),
        _heads(table),
        st.just(b"\x78\x80\x78"),
        st.binary(max_size=12),
        st.lists(st.sampled_from(b"\xfe\xfa\x02\x0e\x20\x00"), max_size=12).map(bytes),
    )


@lru_cache
def tails(table: Table) -> st.SearchStrategy[bytes]:
    """Draw noise that ends like the start of a frame: most readers then lose the next frame."""
    heads = _heads(table)
    return st.one_of(
        noise_of(table, "header bytes", "servo FE"),
        heads,
        st.builds(lambda head, cut: head[:cut], heads, st.integers(1, 3)),
        st.sampled_from([b"\xfe\xfe\x77", b"\xfe\xfe\x0e\x99", b"\xfe\xfe\x03\x20"]),
    )


@st.composite
def received(draw: st.DrawFn, frames: st.SearchStrategy[bytes], table: Table) -> Received:
    """Draw frames as they arrive over a bad line, with noise and damaged frames among them."""
    data, whole = bytearray(), []
    for kind in draw(KINDS):
        if kind == "damaged":
            fault = draw(DAMAGE)
            data += damaged(fault, draw(frames), table, draw(DRAWS))
            continue
        if kind != "frame":
            data += draw(line_noise(table) if kind == "noise" else tails(table))
        if kind != "noise":
            frame = draw(frames)
            whole.append((len(data), frame))
            data += frame
    return Received(bytes(data), whole)


def _heads(table: Table) -> st.SearchStrategy[bytes]:
    """Return header, LEN and id of every message of the edition, without the rest of the frame."""
    return st.sampled_from(
        [
            table.frame.header + bytes([table.frame.length(variant.size), command.id])
            for command in table.commands
            for variant in (*command.request, *command.reply)
        ]
    )
