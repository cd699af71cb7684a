"""Read bytes to decode: hex arguments, a file or standard input, as raw bytes or hex text."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import IO, Literal, NamedTuple

from cobotwire.capture.file_errors import unusable_file
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.printable import printable

ByteFormat = Literal["raw", "hex"]

# Bytes to read at a time. A pipe returns what it has.
BLOCK = 1 << 18
# The number of bytes that decide between raw bytes and hex text. All of them are read, unless a
# byte comes that cannot be text: so the result does not depend on how a pipe cuts the input.
DETECT = 512

_HEX = re.compile(rb"(?:[\s,;:]|0[xX]|[0-9A-Fa-f]{2})*")
_SEPARATORS = re.compile(rb"0[xX]|[\s,;:]+")
# A byte order mark before hex digits: UTF-8, or UTF-16 in either byte order.
_MARKED = re.compile(rb"\xef\xbb\xbf[0-9A-Fa-f]|\xff\xfe[0-9A-Fa-f]\0|\xfe\xff\0[0-9A-Fa-f]")
_TEXT = frozenset(b"\t\n\v\f\r" + bytes(range(0x20, 0x7F)))


class ByteSource(NamedTuple):
    """Blocks of bytes, each with the number of input bytes that were read for it.

    ``size`` is the length of the input in bytes, if it is known. ``from_arguments`` is whether the
    arguments themselves are the bytes.
    """

    blocks: Iterator[tuple[bytes, int]]
    size: int | None
    from_arguments: bool


def open_bytes(
    arguments: Sequence[str], format: ByteFormat | None, notify: Callable[[str], None]
) -> ByteSource:
    """Open what the arguments name: bytes in hex, a file, or ``-`` for standard input.

    If ``format`` is None, it is detected. If the input then is hex text, ``notify`` is called with
    a sentence about it.

    Raises:
        UsageError: the arguments name no bytes, or they are ambiguous.
        LinkError: while reading: the input cannot be read to its end.
    """
    name = arguments[0]
    if format is None and name != "-":
        data = hex_arguments(arguments)
        if data is not None:
            if len(arguments) == 1 and os.path.exists(name):
                message = (
                    f"{name} is both a file and hex: "
                    f"use ./{name} for the file, 0x{name} for the bytes"
                )
                raise UsageError("FILE", name, message=message)
            return ByteSource(iter([(data, len(data))]), len(data), from_arguments=True)
    if len(arguments) > 1:
        text = " ".join(arguments)
        message = f"{text} is not hex; give pairs of hex digits, one FILE, or -"
        raise UsageError("HEX", text, message=message)
    stream = _open(name)
    status = os.fstat(stream.fileno())
    size = status.st_size if stat.S_ISREG(status.st_mode) else None
    return ByteSource(_read(stream, name, format, notify), size, from_arguments=False)


def hex_arguments(arguments: Sequence[str]) -> bytes | None:
    """Return the bytes if the arguments are pairs of hex digits, else None."""
    text = " ".join(arguments).encode(errors="replace")
    if not _HEX.fullmatch(text):
        return None
    return _unhex(text)


def _open(name: str) -> IO[bytes]:
    try:
        if name == "-":
            return open(0, "rb", buffering=0, closefd=False)
        return open(name, "rb", buffering=0)
    except (OSError, ValueError) as error:
        raise unusable_file("FILE", name, error) from None


def _read(
    stream: IO[bytes], name: str, format: ByteFormat | None, notify: Callable[[str], None]
) -> Iterator[tuple[bytes, int]]:
    with stream:
        blocks = _blocks(stream, name)
        first = b""
        if format is None:
            first, format = _detect(blocks, name)
            if format == "hex":
                notify(f"reading {printable(name)} as hex text (--raw: read it as raw bytes)")
        yield from _raw(first, blocks) if format == "raw" else _hex(first, blocks, name)


def _blocks(stream: IO[bytes], name: str) -> Iterator[bytes]:
    try:
        while block := stream.read(BLOCK):
            yield block
    except OSError as error:
        raise LinkError(name, f"reading failed: {error.strerror}") from error


def _detect(blocks: Iterator[bytes], name: str) -> tuple[bytes, ByteFormat]:
    """Return the bytes that were read to detect the format, and the format."""
    start = b""
    while len(start) < DETECT and _TEXT.issuperset(start):
        block = next(blocks, b"")
        if not block:
            break
        start += block
    head = start[:DETECT]
    if _MARKED.match(head):
        raise _not_hex(name, f"{name} is Unicode text with a byte order mark, not plain hex")
    if not _TEXT.issuperset(head):
        return start, "raw"
    # The second digit of the last pair may come after the head.
    if len(head) - _end_of_hex(head) > 1:
        raise _not_hex(name, f"{name} is text, but not hex")
    return start, "hex"


def _not_hex(name: str, problem: str) -> UsageError:
    return UsageError("FILE", name, message=f"{problem}; --raw decodes it as raw bytes")


def _end_of_hex(text: bytes) -> int:
    found = _HEX.match(text)
    assert found is not None, "the pattern matches the empty text"
    return found.end()


def _raw(first: bytes, blocks: Iterator[bytes]) -> Iterator[tuple[bytes, int]]:
    if first:
        yield first, len(first)
    for block in blocks:
        yield block, len(block)


def _hex(first: bytes, blocks: Iterator[bytes], name: str) -> Iterator[tuple[bytes, int]]:
    place, rest = 0, b""
    for block in chain([first], blocks):
        text = rest + block
        end = _end_of_hex(text)
        if len(text) - end > 1:
            raise _not_hex(name, f"byte {place + end} of {name} is not a pair of hex digits")
        yield _unhex(text[:end]), len(block)
        place, rest = place + end, text[end:]
    if rest:
        raise _not_hex(name, f"byte {place} of {name} is not a pair of hex digits")


def _unhex(text: bytes) -> bytes:
    return bytes.fromhex(_SEPARATORS.sub(b"", text).decode("ascii"))
