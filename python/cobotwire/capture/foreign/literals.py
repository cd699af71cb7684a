r"""Read bytes as Python prints them: ``b'\xfe\xfe'``, ``[254, 254]``, ``bytearray(b'\xfe')``."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from cobotwire.capture.foreign.reader import (
    LONGEST_LINE,
    Chunk,
    ForeignFile,
    Line,
    Reader,
    starts_with,
)

WHAT = "Python literals"
_NUMBER = "(?:0x[0-9a-f]{1,2}|[0-9]{1,3})"
# Only escapes that stand for one byte, so that evaluating a literal causes no error and no warning.
_ESCAPE = r"\\(?:x[0-9a-f]{2}|[0-3]?[0-7]{1,2}|[\\'\"abfnrtv])"
_TEXT = rf"b'(?:[ -&(-\[\]-~]|{_ESCAPE})*'|b\"(?:[ !#-\[\]-~]|{_ESCAPE})*\""
_LIST = rf"[\[(]\s*(?:{_NUMBER}\s*,\s*)*(?:{_NUMBER}\s*)?[\])]"
_LITERAL = re.compile(
    rf"\s*(?:(?P<type>bytes|bytearray)\s*\(\s*)?(?:(?P<text>{_TEXT})|(?P<list>{_LIST}))"
    r"(?(type)\s*\))[\s,;]*",
    re.IGNORECASE,
)
_NUMBERS = re.compile(_NUMBER, re.IGNORECASE)
_CLOSE = re.compile(r"[\])]")
_OPEN = re.compile(r"\s*(?:(?:bytes|bytearray)\s*\(\s*)?[\[(][\s0-9a-fx,]*", re.IGNORECASE)


def _read(file: ForeignFile) -> Iterator[Chunk]:
    first, held, size = Line(0, ""), [""], 0
    for line in file.lines():
        size += len(line.text)
        if held[0] and not _CLOSE.search(line.text) and size < LONGEST_LINE:
            # The middle of a list. Joining the text at each line would take quadratic time.
            held.append(line.text)
            continue
        first = first if held[0] else line
        text, at = "\n".join([*held, line.text]), 0
        while found := _LITERAL.match(text, at):
            yield Chunk(_bytes_of(file, first, found))
            at = found.end()
        held, size = [text[at:].strip()], len(text) - at
        # A list may continue on the next line.
        if held[0] and not (_OPEN.fullmatch(held[0]) and size < LONGEST_LINE):
            file.reject(first._replace(text=held[0]), rf"{WHAT}: b'\xfe\xfe', [254, 254]")
    if held[0]:
        file.reject(first._replace(text=held[0]), f"the end of a list in {WHAT}")


def _bytes_of(file: ForeignFile, line: Line, found: re.Match[str]) -> bytes:
    if found["text"]:
        return bytes(ast.literal_eval(found["text"]))
    numbers = [
        int(each, 16 if each[:2].lower() == "0x" else 10)
        for each in _NUMBERS.findall(found["list"])
    ]
    if max(numbers, default=0) > 0xFF:
        file.reject(line, f"bytes from 0 to 255 in {WHAT}")
    return bytes(numbers)


READERS = (
    Reader(
        "python",
        WHAT,
        starts_with(
            rb"(?:(?:bytes|bytearray)\s*\(\s*)?(?:b['\"]|[\[(]\s*"
            + _NUMBER.encode()
            + rb"\s*[,\])])"
        ),
        _read,
        plain=True,
    ),
)
