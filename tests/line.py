"""What a real line carries, as strategies: the field's noise, and what happens to frames on it."""

from __future__ import annotations

from typing import NamedTuple

from hypothesis import strategies as st

from cobotwire.sim.faults import noise
from cobotwire.table import Layout, Table

ACK = b"\xfe\xfe\x03\x10\x01\xfa"
TEXTS = [
    noise.COMMAND_ERROR,
    b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n",
    b"Backtrace: 0x400d1f3c:0x3ffb1f20 0x400d2a81:0x3ffb1f40\r\n\r\nRebooting...\r\n",
]

# A whole frame, one behind a tail of noise, a damaged one, and noise alone.
KINDS = ["whole", "tail", "damaged", "noise"]


class Received(NamedTuple):
    """What came of the frames that were sent: the bytes, and each frame that came whole."""

    data: bytes
    whole: list[tuple[int, bytes]]


@st.composite
def servo_packets(draw: st.DrawFn) -> bytes:
    """A valid Feetech packet: any id, instruction or error byte, parameters; then the checksum."""
    parameters = draw(st.binary(max_size=12) | st.lists(st.sampled_from(b"\xfe\xfa\xff\x0e")))
    instruction = draw(st.sampled_from(b"\x01\x02\x03\x04\x05\x82\x83") | st.integers(0, 255))
    head = [draw(st.integers(0, 254)), len(parameters) + 2, instruction]
    return noise.servo_packet(bytes(head) + bytes(parameters))


@st.composite
def servo_packets_ending_in_a_header_byte(draw: st.DrawFn) -> bytes:
    """A Feetech packet whose checksum is FE: with a frame behind it, FE FE FE LEN."""
    parameters = draw(st.binary(max_size=8))
    body = bytes([draw(st.integers(0, 254)), len(parameters) + 3, 3]) + parameters
    return noise.servo_packet(body + bytes([(0x01 - sum(body)) & 0xFF]))


def false_headers(table: Table) -> st.SearchStrategy[bytes]:
    """``FE FE LEN CMD`` of a message that the edition has, with nothing behind it."""
    return st.sampled_from([_head(table, id, layout) for id, layout in _forms(table)])


def merged_acks() -> st.SearchStrategy[bytes]:
    """The late acknowledgement of an earlier order, glued to what comes next."""
    return st.just(ACK)


def line_noise(table: Table) -> st.SearchStrategy[bytes]:
    """Noise as a line carries it, any one piece of it."""
    return st.one_of(
        servo_packets(),
        servo_packets_ending_in_a_header_byte(),
        st.sampled_from(TEXTS),
        st.tuples(st.sampled_from(TEXTS), st.integers(0, 20)).map(lambda cut: cut[0][cut[1] :]),
        st.integers(1, 300).map(bytes),
        st.integers(1, 5).map(lambda count: b"\xfe" * count),
        false_headers(table),
        merged_acks(),
        st.just(b"\x78\x80\x78"),
        st.binary(max_size=12),
        st.lists(st.sampled_from(b"\xfe\xfa\x02\x0e\x20\x00"), max_size=12).map(bytes),
    )


@st.composite
def damaged(draw: st.DrawFn, frame: bytes, table: Table) -> bytes:
    """The frame after a byte was dropped, flipped or put in, or noise came in the middle of it."""
    place = draw(st.integers(0, len(frame) - 1))
    kind = draw(st.sampled_from(["drop", "flip", "insert", "noise", "cut"]))
    before, behind = frame[:place], frame[place + 1 :]
    if kind == "drop":
        return before + behind
    if kind == "flip":
        return before + bytes([frame[place] ^ 1 << draw(st.integers(0, 7))]) + behind
    if kind == "cut":
        return before
    between = draw(st.binary(min_size=1, max_size=1) if kind == "insert" else line_noise(table))
    return frame[: place + 1] + between + behind


def tails(table: Table) -> st.SearchStrategy[bytes]:
    """Noise whose last bytes could begin a frame: what most readers lose the next frame to."""
    return st.one_of(
        st.integers(1, 5).map(lambda count: b"\xfe" * count),
        servo_packets_ending_in_a_header_byte(),
        false_headers(table),
        st.tuples(false_headers(table), st.integers(1, 3)).map(lambda cut: cut[0][: cut[1]]),
        st.sampled_from([b"\xfe\xfe\x77", b"\xfe\xfe\x0e\x99", b"\xfe\xfe\x03\x20"]),
    )


@st.composite
def received(draw: st.DrawFn, frames: st.SearchStrategy[bytes], table: Table) -> Received:
    """Frames as they come in over a bad line, noise and broken ones among them."""
    data, whole = bytearray(), []
    for kind in draw(st.lists(st.sampled_from(KINDS), min_size=1, max_size=9)):
        if kind == "damaged":
            data += draw(damaged(draw(frames), table))
            continue
        data += (
            b"" if kind == "whole" else draw(tails(table) if kind == "tail" else line_noise(table))
        )
        if kind != "noise":
            frame = draw(frames)
            whole.append((len(data), frame))
            data += frame
    return Received(bytes(data), whole)


def _forms(table: Table) -> list[tuple[int, Layout]]:
    return [
        (command.id, layout)
        for command in table.commands
        for layout in (*command.request, *command.reply)
    ]


def _head(table: Table, id: int, layout: Layout) -> bytes:
    return table.frame.header + bytes([table.frame.length(layout.size), id])
