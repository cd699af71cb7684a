"""Read dumps of bytes with offsets: ``xxd``, ``hexdump -C`` and ``od -A x -t x1z``.

A line has an offset, bytes in hex, and in most dumps the same bytes as text. A line ``*`` stands
for copies of the line before it, up to the next offset. The formats are those of the programs of
Debian 12; the tests read what these write.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire.capture.foreign.reader import Chunk, ForeignFile, Line, Reader, starts_with

# The most bytes that a line ``*`` may stand for.
MOST_REPEATED = 1 << 24
BLOCK = 1 << 12
_OFFSET = "([0-9a-f]{6,16})"


def _reader(name: str, what: str, line: str, start: bytes) -> Reader:
    pattern = re.compile(line, re.IGNORECASE)
    return Reader(name, what, starts_with(start), lambda file: _read(file, what, pattern), True)


def _read(file: ForeignFile, what: str, pattern: re.Pattern[str]) -> Iterator[Chunk]:
    place: int | None = None
    last, repeated = b"", False
    for line in file.lines():
        if line.text == "*" and last:
            repeated = True
            continue
        data, offset = _parse(file, line, what, pattern)
        place = offset if place is None else place
        if repeated:
            copies, odd = divmod(offset - place, len(last))
            if odd or not 0 < copies * len(last) <= MOST_REPEATED:
                file.reject(line, f"an offset after whole repeated lines ({what})")
            at_once = BLOCK // len(last) + 1
            yield from (Chunk(last * at_once) for _ in range(copies // at_once))
            yield Chunk(last * (copies % at_once))
            place = offset
        if offset != place:
            file.reject(line, f"the offset {place:08x} of {what}")
        place += len(data)
        last, repeated = data or last, False
        if data:
            yield Chunk(data)
    if repeated:
        file.missing.append("ends after a line *, so the number of repeated lines is not known")


def _parse(file: ForeignFile, line: Line, what: str, pattern: re.Pattern[str]) -> tuple[bytes, int]:
    """Return the bytes of a line and its offset. The last line may be an offset only."""
    if re.fullmatch(_OFFSET, line.text, re.IGNORECASE):
        return b"", int(line.text, 16)
    if not (found := pattern.fullmatch(line.text)):
        file.reject(line, f"a line of {what}")
    data = bytes.fromhex(found[2])
    text = "".join(chr(byte) if 0x20 <= byte < 0x7F else "." for byte in data)
    # Spaces at the end of the text may be cut, and those at its start look like the gap before it.
    if found[3] is not None and found[3].strip() != text.strip():
        file.reject(line, f"{text!r} after the bytes, as their text in {what}")
    return data, int(found[1], 16)


def has_offsets(head: bytes) -> bool:
    """Return whether hex text that begins like this has offsets before its bytes.

    Either the first offset is a 0 with more digits than the word after it, or each offset is the
    number of bytes in the lines before it.
    """
    lines = [line.split() for line in head.replace(b":", b" ").splitlines() if line.strip()]
    # The end of the head may cut the last line.
    lines = lines[:-1] if len(lines) > 2 else lines
    try:
        offsets = [int(words[0], 16) for words in lines]
        sizes = [len(bytes.fromhex(b"".join(words[1:]).decode())) for words in lines]
        if sizes[0] and not offsets[0] and len(lines[0][0]) > len(lines[0][1]):
            return True
    except (IndexError, ValueError):
        return False
    ends = [at + size for at, size in zip(offsets, sizes)]
    return len(lines) > 1 and 0 not in sizes[:-1] and ends[:-1] == offsets[1:]


READERS = (
    _reader(
        "xxd",
        "a dump by xxd",
        rf"{_OFFSET}: ((?:[0-9a-f]{{2}} ?)+)(?: +(.*))?",
        rb"[0-9a-f]{8,16}: (?:[0-9a-f]{2})+ ",
    ),
    _reader(
        "hexdump",
        "a dump by hexdump -C",
        rf"{_OFFSET}  ((?:[0-9a-f]{{2}} {{1,2}})+) *\|(.*)\|",
        rb"[0-9a-f]{8,16}  (?:[0-9a-f]{2} {1,2})+ *\|",
    ),
    _reader(
        "od",
        "a dump by od -A x -t x1z",
        rf"{_OFFSET}((?: [0-9a-f]{{2}})+)(?: +>(.*)<)?",
        rb"[0-9a-f]{6}(?: [0-9a-f]{2})+(?: +>|\r?\n[0-9a-f]{6}(?: |\r?\n|$))",
    ),
)
