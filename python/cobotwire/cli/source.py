"""Where ``cobotwire decode`` gets its bytes: hex words, a file or the standard input."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import IO, Literal, NamedTuple

import click

from cobotwire.errors import LinkError, UsageError

Form = Literal["raw", "hex"]

# So much is read at a time. A pipe gives what it has.
BLOCK = 1 << 16
# Raw bytes and hex text are told apart by so many bytes. All are waited for, unless one that
# is no text comes before: so the answer does not depend on how a pipe cuts them.
DETECT = 512

_HEX = re.compile(rb"(?:[\s,;:]|0[xX]|[0-9A-Fa-f]{2})*")
_SEPARATORS = re.compile(rb"0[xX]|[\s,;:]+")
# A text editor's byte order mark before hex: UTF-8, or UTF-16 with a digit behind it.
_MARKED = re.compile(rb"\xef\xbb\xbf[0-9A-Fa-f]|\xff\xfe[0-9A-Fa-f]\0|\xfe\xff\0[0-9A-Fa-f]")
_TEXT = frozenset(b"\t\n\v\f\r" + bytes(range(0x20, 0x7F)))


class Source(NamedTuple):
    """Blocks of bytes, and how many of the input were read for them.

    ``size`` is the input's length in bytes where that is known. ``words``: it is the hex words.
    """

    blocks: Iterator[tuple[bytes, int]]
    size: int | None
    words: bool


def open_source(words: Sequence[str], form: Form | None) -> Source:
    """What the words of the command line mean: hex, a FILE, or ``-``.

    Raises:
        UsageError: they are none of these, or may be two.
        LinkError: while reading: the input cannot be read on.
    """
    name = words[0]
    if form is None and name != "-":
        data = hex_words(words)
        if data is not None:
            if len(words) == 1 and os.path.exists(name):
                raise UsageError("WORDS", name, f"./{name} for the file, 0x{name} for the bytes")
            return Source(iter([(data, len(data))]), len(data), words=True)
    if len(words) > 1:
        raise UsageError("WORDS", " ".join(words), "pairs of hex digits, one FILE, or -")
    stream = _open(name)
    status = os.fstat(stream.fileno())
    size = status.st_size if stat.S_ISREG(status.st_mode) else None
    return Source(_read(stream, name, form), size, words=False)


def hex_words(words: Sequence[str]) -> bytes | None:
    """The bytes, if the words are hex: no pair is torn by a blank."""
    text = " ".join(words).encode(errors="replace")
    if not _HEX.fullmatch(text):
        return None
    return _unhex(text)


def _open(name: str) -> IO[bytes]:
    try:
        if name == "-":
            return open(0, "rb", buffering=0, closefd=False)
        return open(name, "rb", buffering=0)
    except FileNotFoundError:
        raise UsageError("WORDS", name, "pairs of hex digits, a FILE that exists, or -") from None
    except OSError as error:
        raise UsageError("FILE", name, f"one that can be read ({error.strerror})") from None


def _read(stream: IO[bytes], name: str, form: Form | None) -> Iterator[tuple[bytes, int]]:
    with stream:
        blocks = _blocks(stream, name)
        first = b""
        if form is None:
            first, form = _detect(blocks, name)
        yield from _raw(first, blocks) if form == "raw" else _hex(first, blocks, name)


def _blocks(stream: IO[bytes], name: str) -> Iterator[bytes]:
    try:
        while block := stream.read(BLOCK):
            yield block
    except OSError as error:
        raise LinkError(name, f"cannot be read on: {error.strerror}") from error


def _detect(blocks: Iterator[bytes], name: str) -> tuple[bytes, Form]:
    """What was read to tell the form, and the form."""
    start = b""
    while len(start) < DETECT and _TEXT.issuperset(start):
        block = next(blocks, b"")
        if not block:
            break
        start += block
    head = start[:DETECT]
    if _MARKED.match(head):
        raise UsageError("FILE", name, "raw bytes or plain hex; this is Unicode with a mark: --raw")
    if not _TEXT.issuperset(head):
        return start, "raw"
    # The last digit may have its other half behind the head.
    if len(head) - _end_of_hex(head) > 1:
        raise UsageError("FILE", name, "raw bytes or hex; this is other text: --raw takes it as is")
    click.echo(f"cobotwire: reading {name} as hex text (--raw: as raw bytes)", err=True)
    return start, "hex"


def _end_of_hex(text: bytes) -> int:
    found = _HEX.match(text)
    assert found is not None, "the pattern matches anything"
    return found.end()


def _raw(first: bytes, blocks: Iterator[bytes]) -> Iterator[tuple[bytes, int]]:
    if first:
        yield first, len(first)
    for block in blocks:
        yield block, len(block)


def _hex(first: bytes, blocks: Iterator[bytes], name: str) -> Iterator[tuple[bytes, int]]:
    allowed = "pairs of hex digits to the end of the file; or say --raw"
    place, rest = 0, b""
    for block in chain([first], blocks):
        text = rest + block
        end = _end_of_hex(text)
        if len(text) - end > 1:
            raise UsageError(f"byte {place + end} of {name}", text[end : end + 2], allowed)
        yield _unhex(text[:end]), len(block)
        place, rest = place + end, text[end:]
    if rest:
        raise UsageError(f"byte {place} of {name}", rest, allowed)


def _unhex(text: bytes) -> bytes:
    return bytes.fromhex(_SEPARATORS.sub(b"", text).decode("ascii"))
