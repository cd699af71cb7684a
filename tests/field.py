"""Generate the noise of real serial lines: servo leaks, firmware text, reboots, damage."""

from __future__ import annotations

from functools import cache

from hypothesis import strategies as st

import strategies
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.noise import (
    BOOT,
    COMMAND_ERROR,
    LEAKS,
    LOG,
    PANIC,
    servo_packet,
)
from noisy_lines import noise_of


def servo_packets() -> st.SearchStrategy[bytes]:
    """Generate a servo packet of the catalogue, sometimes with another id and any instruction."""
    codes = st.sampled_from([0, 1, 2, 3, 4, 5, 0x20, 0x82, 0x83]) | st.integers(0, 255)
    drawn = noise_of(TABLE, "servo", "servo FE")
    altered = st.builds(
        lambda packet, id, code: servo_packet(bytes([id, packet[3], code]) + packet[5:-1]),
        drawn,
        st.sampled_from([1, 2, 7, 0xFE]) | st.integers(0, 0xFE),
        codes,
    )
    return st.one_of(drawn, altered, st.sampled_from(list(LEAKS.values())))


def damaged_panics() -> st.SearchStrategy[bytes]:
    """Generate a panic dump with some bytes in its middle that are not text."""
    return st.builds(
        lambda cut, bad: PANIC[:cut] + bad + PANIC[cut:],
        st.integers(21, len(PANIC)),
        st.lists(st.integers(0x80, 0xFF), max_size=6).map(bytes),
    )


def damaged_replies() -> st.SearchStrategy[bytes]:
    """Generate the start of a get_angles reply, with or without a footer at the wrong place."""
    return st.builds(
        lambda size, footer: (b"\xfe\xfe\x0e\x20" + bytes(range(16)))[:size] + footer,
        st.integers(1, 19),
        st.sampled_from([b"", b"\xfa", b"\xfb"]),
    )


@cache
def noise() -> st.SearchStrategy[bytes]:
    """Generate noise of firmware, servos and bad lines, complete or cut, short and long."""
    whole = st.one_of(
        servo_packets(),
        st.sampled_from([PANIC, BOOT, COMMAND_ERROR, COMMAND_ERROR.rstrip(), *LOG]),
        st.sampled_from([1, 3, 4, 63, 64, 277, 5000]).map(bytes),
        st.integers(1, 3000).map(lambda size: b"~" * size),
        st.binary(max_size=300),
        strategies.line_noise(),
        damaged_panics(),
        # A message at the limit of a line, and directly after a truncated frame.
        st.integers(1000, 1050).map(lambda size: b"x" * size + COMMAND_ERROR.rstrip()),
        st.builds(
            lambda parts, after: b"".join(parts) + after,
            st.lists(damaged_replies(), min_size=1, max_size=4),
            st.sampled_from([b"", COMMAND_ERROR, PANIC]) | servo_packets(),
        ),
    )
    return st.one_of(
        whole, st.builds(lambda data, cut: data[: cut % (len(data) + 1)], whole, st.integers(0))
    )


@cache
def _pieces(table: Table) -> st.SearchStrategy[list[bytes]]:
    pieces = noise() | strategies.real_frames(table) | strategies.near_frames(table)
    return st.lists(pieces, max_size=6)


@st.composite
def streams(draw: st.DrawFn, table: Table = TABLE) -> bytes:
    """Generate frames and noise; sometimes a frame interrupts a piece of noise."""
    stream = b""
    for piece in draw(_pieces(table)):
        cut = draw(st.integers(0, len(piece))) if draw(st.booleans()) else len(piece)
        stream += piece[:cut]
        if cut < len(piece):
            stream += draw(strategies.real_frames(table)) + piece[cut:]
    return stream
