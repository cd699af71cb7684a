"""Define a reader: how a format is recognised, and how it becomes chunks of bytes."""

from __future__ import annotations

import re
from calendar import timegm
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from decimal import Decimal
from functools import lru_cache
from time import strptime
from typing import NamedTuple, NoReturn

from cobotwire.capture.packet import Direction
from cobotwire.protocol.errors import UnreadableInput
from cobotwire.protocol.printable import printable

# The ports on which the makers' TCP servers listen.
PORTS = (9000, 4500)
LONGEST_LINE = 1 << 20
SHOWN = 40
_SECONDS = re.compile(r"-?[0-9]{1,10}(?:\.[0-9]{1,40})?(?:e-?[0-9]{1,2})?", re.IGNORECASE)


class Chunk(NamedTuple):
    """Bytes that were sent or received together.

    Attributes:
        data: the bytes.
        direction: their direction, if the format has one.
        time_ns: nanoseconds since 1970 (UTC), or since another start; None if there is no time.
        stream: identifies one of several streams: a connection, a channel, a CAN id.
    """

    data: bytes
    direction: Direction = "unknown"
    time_ns: int | None = None
    stream: str = ""


class Line(NamedTuple):
    """A line of a text file without its end; the first one has number 1."""

    number: int
    text: str


@dataclass
class ForeignFile:
    """A file of another program, read from its beginning to its end.

    Attributes:
        name: its name, for messages.
        blocks: its bytes.
        ports: TCP ports of arms.
        notes: what a user should know about how it was read; complete at the end.
        missing: what the file lacks, such as lost packets; complete at the end.
        size: the bytes that were read so far, after decompression.
    """

    name: str
    blocks: Iterator[bytes]
    ports: tuple[int, ...] = PORTS
    notes: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    size: int = 0

    def counted(self) -> Iterator[bytes]:
        """Yield the blocks, and count their bytes."""
        for block in self.blocks:
            self.size += len(block)
            yield block

    def remarks(self) -> list[str]:
        """Return the notes, and a sentence for each thing that is missing."""
        return [*self.notes, *(f"{printable(self.name)} {text}" for text in self.missing)]

    def lines(self) -> Iterator[Line]:
        """Yield the lines that are not blank. Each byte is one character."""
        number, rest = 0, b""
        for block in self.blocks:
            *whole, rest = (rest + block).split(b"\n")
            for text in whole:
                number += 1
                if text.strip():
                    yield Line(number, text.decode("latin-1").rstrip())
            if len(rest) > LONGEST_LINE:
                self.reject(Line(number + 1, ""), f"a line of at most {LONGEST_LINE} characters")
        if rest.strip():
            yield Line(number + 1, rest.decode("latin-1").rstrip())

    def reject(self, line: Line, expected: str) -> NoReturn:
        """Raise the error for a line that the format does not allow."""
        found = line.text if len(line.text) <= SHOWN else line.text[:SHOWN] + "..."
        raise UnreadableInput(
            self.name, f"expected {expected}" + f", found {found!r}" * bool(found), line.number
        )


@dataclass(frozen=True)
class Reader:
    """Reads one format.

    Attributes:
        name: what ``--read-as`` calls it.
        what: what messages call it.
        start: matches the start of a file in this format. The end of the bytes may cut a line.
        chunks: reads a file.
        plain: whether the format has neither times nor directions.
        remark: what messages add about its times; empty if they are times of day in UTC.
    """

    name: str
    what: str
    start: Callable[[bytes], object]
    chunks: Callable[[ForeignFile], Iterator[Chunk]]
    plain: bool = False
    remark: str = ""


def starts_with(pattern: bytes) -> Callable[[bytes], object]:
    """Return a function that matches a pattern at the start of the first line with text."""
    return re.compile(rb"(?:\xef\xbb\xbf)?\s*" + pattern, re.IGNORECASE).match


@lru_cache(maxsize=16)
def day_time_ns(text: str, format: str) -> int | None:
    """Return a time of day without a time zone as if it were UTC; None if it is not a time."""
    try:
        return timegm(strptime(text, format)) * 10**9
    except ValueError:
        return None


def seconds_ns(text: str) -> int | None:
    """Return seconds with decimals as nanoseconds; None if they are something else."""
    return int(Decimal(text) * 10**9) if _SECONDS.fullmatch(text) else None
