"""Run an edition's C code in a separate process, and send it operations."""

from __future__ import annotations

import struct
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, cast

from cobotwire.codec.interface import Event, Frame, Noise, NoiseReason
from cobotwire_codegen.model import Edition

STATUS = (
    "ok",
    "no-header",
    "bad-address",
    "bad-length",
    "unknown-id",
    "bad-check",
    "truncated",
    "trailing",
    "bad-value",
    "no-room",
)
LISTENING = {"request": 1, "reply": 2, "both": 3}


class Outcome(NamedTuple):
    """The C code's status, and for a rejection its place."""

    status: str
    message: int
    field: int
    element: int
    offset: int


class Read(NamedTuple):
    """A decoded message: its index, its raw values, its physical values."""

    message: int
    raw_values: list[int]
    values: list[float]


def comparable(value: float) -> float:
    """Return a number that equals itself: NaN becomes a number that no message carries."""
    return float(value) if value == value else 1e300


class CPeer:
    """Talk to a harness in its own process; report what the sanitizers found."""

    def __init__(self, program: Path, edition: Edition) -> None:
        self._frame = edition.frame
        self._process = subprocess.Popen(
            [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )

    def __enter__(self) -> CPeer:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the process; fail if a sanitizer found an error or a leak."""
        _, errors = self._process.communicate()
        assert self._process.returncode == 0, errors.decode()

    def encode(
        self, message: int, raw_values: Sequence[int], address: int = 0, room: int = 20_000
    ) -> bytes | Outcome:
        """Build a frame from raw values."""
        return self._encode(message, False, raw_values, [0.0] * len(raw_values), address, room)

    def encode_values(
        self, message: int, values: Sequence[float], address: int = 0
    ) -> bytes | Outcome:
        """Build a frame from physical values, with the header's helpers."""
        # The number of elements of a list is an integer in both rows.
        counts = [int(value) if abs(value) < 2**31 else 0 for value in values]
        return self._encode(message, True, counts, values, address, 20_000)

    def _encode(
        self,
        message: int,
        from_values: bool,
        raw_values: Sequence[int],
        values: Sequence[float],
        address: int,
        room: int,
    ) -> bytes | Outcome:
        count = len(values)
        head = struct.pack("=cHHHHH", b"e", message, address, room, from_values, count)
        self._send(head + struct.pack(f"={count}q{count}d", *raw_values, *values))
        outcome = self._outcome()
        frame = self._take(self._u16())
        return frame if outcome.status == "ok" else outcome

    def decode(self, message: int, data: bytes) -> Read | Outcome:
        """Read a frame as one message."""
        return self._decode(b"d", message, data)

    def read(self, listening: str, data: bytes) -> Read | Outcome:
        """Read a frame as the first message that allows it."""
        return self._decode(b"r", LISTENING[listening], data)

    def _decode(self, operation: bytes, which: int, data: bytes) -> Read | Outcome:
        self._send(struct.pack("=cHH", operation, which, len(data)) + data)
        outcome, message = self._outcome(), self._u16()
        if outcome.status != "ok":
            return outcome
        numbers = [struct.unpack("=qd", self._take(16)) for _ in range(self._u16())]
        values = [comparable(value) for _, value in numbers]
        return Read(message, [raw for raw, _ in numbers], values)

    def events(
        self,
        listening: str,
        chunks: Sequence[tuple[bytes, bool]],
        accept_unknown: bool = False,
    ) -> tuple[list[Event], int]:
        """Frame a stream, with a flush after the marked chunks; return events and bytes waiting."""
        parts = [struct.pack("=cHHH", b"f", LISTENING[listening], accept_unknown, len(chunks))]
        for data, flush in chunks:
            parts += [struct.pack("=HH", flush, len(data)), data]
        self._send(b"".join(parts))
        return [event for _ in chunks for event in self._events()], self._u16()

    def _events(self) -> Iterator[Event]:
        while self._u16():
            reason, offset, size = struct.unpack("=HQH", self._take(12))
            data, found = self._take(size), STATUS[reason]
            number, at = self._frame.command_number, self._frame.offset("command")
            id = int.from_bytes(data[at : at + number.width], number.order)
            noise = Noise(offset, data, cast(NoiseReason, found))
            yield Frame(offset, data, id) if found == "ok" else noise

    def names(self) -> list[list[str]]:
        """Return each message's name and the names of its fields."""
        self._send(b"n")
        assert self._process.stdout is not None
        return [line.decode().split() for line in iter(self._process.stdout.readline, b"\n")]

    def _outcome(self) -> Outcome:
        status, *where = struct.unpack("=5H", self._take(10))
        return Outcome(STATUS[status], *where)

    def _u16(self) -> int:
        (value,) = struct.unpack("=H", self._take(2))
        return int(value)

    def _send(self, data: bytes) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(data)
        self._process.stdin.flush()

    def _take(self, size: int) -> bytes:
        assert self._process.stdout is not None
        data = self._process.stdout.read(size)
        assert len(data) == size, (self._process.stderr and self._process.stderr.read()) or b""
        return data
