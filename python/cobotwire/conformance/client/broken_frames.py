"""Put the pieces of a broken frame together, and describe it: command, LEN, bytes.

A framer rejects a broken frame byte by byte, so its bytes arrive as several pieces of noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cobotwire.codec.interface import Noise
from cobotwire.conformance.client.history import Received
from cobotwire.conformance.hex_text import shown
from cobotwire.protocol.table import Command, FrameFormat, Table
from cobotwire.simulator.peer import IDLE_SECONDS

# Of a longer frame only the start is shown; most editions have no frame of this size.
MOST = 40


def joined(pieces: Sequence[Received]) -> list[Received]:
    """Return the broken frames and the stray bytes that consecutive pieces of noise make up.

    Noise that does not begin a frame is added to the broken frame before it, if no pause lies
    between them.
    """
    found: list[Received] = []
    for piece in pieces:
        whole = found[-1] if found else piece
        assert whole.noise is not None, "only noise is joined"
        begins = piece is whole or piece.noise is None or piece.noise.reason != "no-header"
        if begins or piece.at - whole.at >= IDLE_SECONDS:
            found.append(piece)
        else:
            longer = whole.noise._replace(data=whole.data + piece.data)
            found[-1] = replace(whole, event=longer)
    return found


def meant(table: Table, data: bytes) -> list[Command]:
    """Return the commands that have the id of a broken frame."""
    if len(data) < table.frame.head_size:
        return []
    id = table.frame.read_id(data)
    return [command for command in table.commands if command.id == id and command.request]


def described(table: Table, noise: Noise) -> str:
    """Say what is wrong with a broken frame or stray bytes, and show all of the bytes."""
    frame, data = table.frame, noise.data
    commands = meant(table, data)
    name = names(commands) or "the request"
    text = marked(frame, data, end=noise.reason == "bad-check")
    if noise.reason == "no-header":
        return f"bytes outside any frame: {shown(data)}"
    if len(data) < frame.head_size:
        return f"a frame that breaks off, or bytes outside any frame: {shown(data)}"
    length, id = frame.read_length(data), frame.read_id(data)
    if noise.reason == "bad-length":
        allowed = f"{name} has LEN {lengths(table, commands)}"
        return f"LEN is {length:02X}, but {allowed}: {text}"
    if noise.reason == "unknown-id":
        return f"{table.edition} has no command with the id {id:02X}: {text}"
    if noise.reason == "bad-address":
        allowed = ", ".join(f"{address:02X}" for address in frame.addresses)
        return f"{name}: {table.edition} has no such address (it has {allowed}): {text}"
    if noise.reason == "truncated":
        missing = length + frame.overhead - len(data)
        if missing <= 0:
            return (
                f"{name} is sent in parts with a pause of over {1000 * IDLE_SECONDS:g} ms: {text}"
            )
        return f"{name} breaks off: LEN {length:02X} requires {missing} more bytes: {text}"
    return f"{name} does not end with {_right_end(frame, data)}: {text}"


def _right_end(frame: FrameFormat, data: bytes) -> str:
    """Describe the end that a frame must have, and how many bytes precede it according to LEN."""
    total = frame.read_length(data) + frame.overhead
    word = "the check" if frame.check else "the footer"
    right = frame.end(data[: total - frame.check_size])
    return f"{word} {shown(right)} after {total - frame.check_size} bytes"


def lengths(table: Table, commands: Sequence[Command]) -> str:
    """Return each LEN that requests of the commands may have, in words."""
    allowed = {table.frame.length(v.size) for command in commands for v in command.request}
    return " or ".join(f"{length:02X}" for length in sorted(allowed))


def names(commands: Sequence[Command]) -> str:
    """Return the names of commands that share an id, in words."""
    return " or ".join(command.name for command in commands)


def marked(frame: FrameFormat, data: bytes, *, end: bool = False) -> str:
    """Return a frame in hex with LEN and id named; with ``end``, check and footer too."""
    if len(data) < frame.head_size:
        return shown(data)
    marks = {
        frame.length_at: (frame.length_number.width, "LEN"),
        frame.id_at: (frame.id_number.width, "id"),
    }
    if frame.address_at is not None:
        marks[frame.address_at] = (1, "address")
    if end:
        word = "check" if frame.check else "footer"
        ends = frame.read_length(data) + frame.overhead
        marks[max(frame.head_size, ends - frame.check_size)] = (frame.check_size, word)
    parts, at = [], 0
    while at < min(len(data), MOST):
        width, word = marks.get(at, (1, ""))
        text = shown(data[at : at + width])
        parts.append(f"[{word} {text}]" if word else text)
        at += width
    more = f" ... ({len(data)} bytes)" if at < len(data) else ""
    return " ".join(parts) + more
