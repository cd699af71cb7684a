"""Recognise the format of a file by its first bytes."""

from __future__ import annotations

import re
from codecs import BOM_UTF8, getincrementaldecoder
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from cobotwire.capture.block_parsing import is_capture
from cobotwire.capture.foreign import analysers, dumps, literals, logs, network
from cobotwire.capture.foreign.hex_text import is_hex, read_hex
from cobotwire.capture.foreign.reader import PORTS, Chunk, ForeignFile, Reader
from cobotwire.capture.foreign.recording import recording_of
from cobotwire.protocol.counted import counted
from cobotwire.protocol.errors import EmptyInput, UnreadableInput, UsageError
from cobotwire.protocol.printable import printable

# The number of bytes that decide about text. All of them are read, up to a byte that cannot be
# text, so that the result does not depend on the chunks that a pipe returns.
DETECT = 512
# How many bytes decide about a pcapng file, since they state the link type; how many decide about
# other binary files, by their magic number.
DETECT_BLOCKS, DETECT_MAGIC = 4096, 4
# How many bytes to pass on at once, if the format has no times.
JOINED = 1 << 16
# How many characters of the first line a message shows.
SHOWN = 120
_CONTROL = re.compile(r"[^\t\n\v\f\r\x20-\x7e\x80-\U0010ffff]")

HEX = Reader(
    "hex",
    "hex text",
    lambda head: is_hex(head, cut=True),
    lambda file: map(Chunk, read_hex(file.blocks, file.name)),
    plain=True,
)
TEXTS = (*dumps.READERS, *literals.READERS, *logs.READERS, *analysers.READERS)
READERS = (HEX, *TEXTS, *network.READERS)
FORMATS = ("raw", *(reader.name for reader in READERS))

# Formats that cannot be read: their first bytes, their name, and what to do.
_SALEAE = "export the table of its 'Async Serial' analyser as CSV"
UNREADABLE = (
    (
        rb"PK\x03\x04(?s:.{26})(?:meta\.json|digital-|analog-)",
        f"a project of Saleae Logic: {_SALEAE}",
    ),
    (
        rb"PK\x03\x04(?s:.{26})(?:version|metadata|logic-)",
        "a session of sigrok: sigrok-cli -i FILE -P uart:baudrate=115200:rx=D0 -A uart=rx-data",
    ),
    (rb"PK\x03\x04|7z\xbc\xaf|BZh[1-9]|\xfd7zXZ\0|Rar!", "an archive: unpack it first"),
    (rb"SQLite format 3\0", "an SQLite database: print the column that holds the bytes as hex"),
    (
        rb"LOGG(?s:.{4})",
        "a CAN log in BLF: convert it with python-can, can_logconvert FILE NEW.log",
    ),
    (rb"<SALEAE>", f"samples of Saleae Logic: {_SALEAE}"),
    (
        rb"\xff\xfe[\t\n\r -~]\0|\xfe\xff\0[\t\n\r -~]|(?:[ -~]\0){4}",
        "Unicode text in UTF-16, as PowerShell writes it: save it as UTF-8",
    ),
    (rb"\xa1\xb2\xcd\x34|\x34\xcd\xb2\xa1", "a modified pcap file: editcap -F pcap FILE FILE.pcap"),
    (rb"\s*[<>] [0-9/]{10} [0-9:.]+  length=", "socat -v, which loses bytes: record with socat -x"),
    (rb"[0-9a-f]{7}(?: +[0-9a-f]{4})+\r?\n", "hexdump in 16-bit words: use hexdump -C, or xxd"),
    (rb"[0-7]{7}(?: [0-7]{6})+\r?\n", "a dump in octal: use od -A x -t x1z, or xxd"),
    (rb"\s*(?:\{|\[\s*[{\[\"])", "JSON: print its bytes as hex"),
)


# What an export writes: Parquet, Arrow, MCAP, and the columns of a CSV file.
EXPORTED = re.compile(rb'PAR1|ARROW1|\x89MCAP|"robot","source","offset",')
RAW = "--raw decodes it as raw bytes"
OFFSETS = "looks like a dump with offsets before the bytes: write it with xxd or hexdump -C"


class ExportedInput(UnreadableInput):
    """An error of an input file: an export wrote it, so it holds no serial bytes."""

    def __init__(self, name: str) -> None:
        super().__init__(name, f"was written by an export, and holds no serial bytes; {RAW}")


class Recognised(NamedTuple):
    """A file in a known format.

    Attributes:
        reader: what reads it; None for raw bytes and for recordings.
        recording: whether the blocks are those of a pcapng file, and not serial bytes.
        blocks: the bytes.
        file: what was learnt about it; complete when all blocks are read.
    """

    reader: Reader | None
    recording: bool
    blocks: Iterator[bytes]
    file: ForeignFile

    @property
    def notice(self) -> str:
        """How the file is read, for people; empty for raw bytes and for recordings."""
        if self.reader is None:
            return ""
        raw = " (--raw: read it as raw bytes)" * (self.reader not in network.READERS)
        remark = f"; {self.reader.remark}" * bool(self.reader.remark)
        return f"reading {printable(self.file.name)} as {self.reader.what}{raw}{remark}"


def recognise(
    blocks: Iterator[bytes],
    name: str,
    format: str | None = None,
    ports: Sequence[int] = (),
    missing: list[str] | None = None,
) -> Recognised:
    """Return the contents of a file as blocks of a recording, or as serial bytes.

    Args:
        blocks: the file.
        name: its name, for messages.
        format: one of ``FORMATS``; None to detect it.
        ports: the TCP ports of arms; empty for the usual ones.
        missing: a list of what the file lacks; the source of the blocks may append to it, too.

    Raises:
        UsageError: there is no such format.
        UnreadableInput: the file is empty, or its format is not known; while reading the blocks:
            a line is wrong.
    """
    if format not in (None, *FORMATS):
        raise UsageError("format", format, ", ".join(FORMATS))
    file = ForeignFile(name, blocks, tuple(ports) or PORTS)
    file.missing = file.missing if missing is None else missing
    blocks = file.counted()
    if not (start := next(blocks, b"")):
        raise EmptyInput(name)
    file.blocks = chain([start], blocks)
    if format == "raw":
        return Recognised(None, False, file.blocks, file)
    if format is not None:
        [reader] = (each for each in READERS if each.name == format)
        return _read_by(reader, file)
    start = _completed(start, blocks)
    if is_text(start):
        start = start.removeprefix(BOM_UTF8)
    file.blocks = chain([start], blocks)
    if found := _reader_of(start[:DETECT_BLOCKS], name):
        return _read_by(found, file)
    if is_text(start):
        problem = _unknown_text(start[:DETECT])
        raise UnreadableInput(name, f"{problem}; {RAW}")
    return Recognised(None, is_capture(start), file.blocks, file)


def _completed(start: bytes, blocks: Iterator[bytes]) -> bytes:
    """Return the bytes that were read to detect the format."""
    while len(start) < _wanted(start) and (block := next(blocks, b"")):
        start += block
    return start


def _wanted(start: bytes) -> int:
    if network.PCAP.start(start) or is_capture(start):
        return DETECT_BLOCKS
    return DETECT if is_text(start) else DETECT_MAGIC


def is_text(start: bytes) -> bool:
    """Return whether a file that begins like this can be text: UTF-8 without control characters."""
    try:
        return not _CONTROL.search(getincrementaldecoder("utf-8")().decode(start[:DETECT]))
    except UnicodeDecodeError:
        return False


def _reader_of(head: bytes, name: str) -> Reader | None:
    """Return the reader for a file that begins like this; None for raw bytes and recordings."""
    found = [reader for reader in network.READERS if reader.start(head)]
    if found or is_capture(head):
        return found[0] if found else None
    head = head[:DETECT]
    if is_text(head):
        found = [reader for reader in TEXTS if reader.start(head)]
        if not found and is_hex(head, cut=True):
            if dumps.has_offsets(head):
                raise UnreadableInput(name, f"{OFFSETS}; {RAW}, --hex decodes all digits")
            found = [HEX]
    if len(found) > 1:
        what = " and ".join(reader.what for reader in found)
        names = " or ".join(f"--read-as {reader.name}" for reader in found)
        raise UnreadableInput(name, f"can be {what}: choose with {names}")
    if found:
        return found[0]
    if EXPORTED.match(head):
        raise ExportedInput(name)
    for pattern, problem in UNREADABLE:
        if re.match(pattern, head, re.IGNORECASE):
            raise UnreadableInput(name, f"looks like {problem}; {RAW}")
    return None


def _unknown_text(head: bytes) -> str:
    """Describe a text that no reader knows."""
    first = head.decode("utf-8", "replace").strip().partition("\n")[0].strip()
    columns = [each.strip(' "') for each in first.split(",")]
    if len(columns) > 1 and all(columns):
        return (
            f"looks like a CSV with {counted(len(columns), 'column')}: {printable(first)[:SHOWN]}; "
            "expected an 'Async Serial' table of Saleae Logic, or bytes in hex"
        )
    return "is text, but not hex nor another known format (see --help)"


def _read_by(reader: Reader, file: ForeignFile) -> Recognised:
    if reader.plain:
        return Recognised(reader, False, _joined(reader, file), file)
    return Recognised(reader, True, recording_of(reader, file), file)


def _joined(reader: Reader, file: ForeignFile) -> Iterator[bytes]:
    held: list[bytes] = []
    size = 0
    for chunk in reader.chunks(file):
        held.append(chunk.data)
        size += len(chunk.data)
        if size >= JOINED:
            yield b"".join(held)
            held, size = [], 0
    if size:
        yield b"".join(held)
