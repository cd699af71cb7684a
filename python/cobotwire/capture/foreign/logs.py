"""Read logs with times and directions: of socat, of pymycobot, and of candump."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire.capture.foreign.reader import (
    Chunk,
    ForeignFile,
    Line,
    Reader,
    day_time_ns,
    seconds_ns,
    starts_with,
)
from cobotwire.capture.packet import Direction
from cobotwire.protocol.counted import counted

LOCAL = "its times have no time zone, and are taken for UTC"

_SOCAT = re.compile(
    r"([<>]) ([0-9]{4}(?:/[0-9]{2}){2} [0-9:]{8})\.([0-9]{6}|[0-9]{9})  length=([0-9]{1,9})"
    r" (?:from=([0-9]{1,18}) )?.*"
)
# With -v, at most 16 bytes and their text; without it, all bytes.
_SOCAT_BYTES = re.compile(r"((?: [0-9a-f]{2})+)(?:  .*)?")
_SOCAT_OWN = re.compile(r"[0-9/]{10} [0-9:]{8} socat\[")


def _socat(file: ForeignFile) -> Iterator[Chunk]:
    """Yield the blocks of ``socat -x``, with or without ``-v``, as versions 1.7 and 1.8 write them.

    If ``from`` shows that a direction lacks bytes, or repeats some, the rest is a separate stream.
    A ``from`` of 0 begins another connection.

    Version 1.7.4 prints microseconds in nine digits. Nine digits count as microseconds until a
    value is a second or more; from then on, they count as nanoseconds.
    """
    head = Line(0, "")
    block, data, size = Chunk(b""), b"", 0
    micro = True
    ends: dict[str, int] = {}
    streams: dict[str, str] = {}
    parts = 1
    for line in file.lines():
        if line.text.rstrip() == "--" or _SOCAT_OWN.match(line.text):
            continue
        if len(data) < size:
            found = _SOCAT_BYTES.fullmatch(line.text)
            data += bytes.fromhex(found[1]) if found else b""
            if not found or len(data) > size:
                file.reject(line, f"{size} bytes after line {head.number} of a socat dump")
        else:
            found = _SOCAT.fullmatch(line.text)
            start = found and day_time_ns(found[2], "%Y/%m/%d %H:%M:%S")
            if not found or start is None:
                file.reject(line, "a line of a socat dump, '> 2026/11/24 14:00:00.000000 length=5'")
            micro = micro and (len(found[3]) == 6 or found[3].startswith("000"))
            direction: Direction = "sent" if found[1] == ">" else "received"
            time_ns = start + int(found[3]) * (1000 if micro or len(found[3]) == 6 else 1)
            head, data, size = line, b"", int(found[4])
            begin = int(found[5] or ends.get(direction, 0))
            if begin and begin != ends.get(direction, begin):
                parts += 1
                streams[direction] = f"part {parts}"
                lost = begin - ends[direction]
                what = f"lacks {counted(lost, 'byte')}" if lost > 0 else "repeats bytes"
                follows = f"before line {line.number}; what follows is part {parts}"
                file.missing.append(f"{what} {direction} {follows}")
            ends[direction] = begin + size
            block = Chunk(b"", direction, time_ns, streams.get(direction, ""))
        if data and len(data) == size:
            yield block._replace(data=data)
    if len(data) < size:
        file.missing.append(f"ends before the {counted(size, 'byte')} of line {head.number}")


_PYMYCOBOT = re.compile(r"_(write|read) ?:(.*)")
_PYMYCOBOT_TIME = re.compile(r"([0-9]{4}-[0-9]{2}-[0-9]{2} [0-9:]{8})[.,]([0-9]{3})\b")
_PYMYCOBOT_BYTES = re.compile(r"(?: *[0-9a-f]{1,2}(?= |$))* *", re.IGNORECASE)


def _pymycobot(file: ForeignFile) -> Iterator[Chunk]:
    """Yield what pymycobot 3 and 4 log with ``debug=True`` (``common.py``, ``log.py``).

    Most of its classes print bytes below 16 with one digit.
    """
    others = empty = 0
    timed: bool | None = None
    for line in file.lines():
        if not (found := _PYMYCOBOT.search(line.text)):
            others += 1
            continue
        if not _PYMYCOBOT_BYTES.fullmatch(found[2]):
            file.reject(line, f"bytes in hex after _{found[1]}")
        stamp = _PYMYCOBOT_TIME.match(line.text)
        time_ns = day_time_ns(stamp[1], "%Y-%m-%d %H:%M:%S") if stamp else None
        if stamp and time_ns is not None:
            time_ns += int(stamp[2]) * 10**6
        timed = bool(stamp) if timed is None else timed
        if timed != (time_ns is not None):
            file.reject(line, "a time, 2026-11-24 14:00:00.000, in all lines or in none")
        if data := bytes(int(each, 16) for each in found[2].split()):
            direction: Direction = "sent" if found[1] == "write" else "received"
            yield Chunk(data, direction, time_ns)
        else:
            empty += 1
    if empty:
        file.notes.append(f"left out {counted(empty, 'line')} of {file.name} without bytes")
    if others:
        file.notes.append(
            f"left out {counted(others, 'line')} of {file.name} without _write or _read"
        )


_ID = "(?:[0-9a-f]{3}|[0-9a-f]{8})"
_CANDUMP = re.compile(
    r"(?:\((?P<time>[0-9 .:-]{3,32})\) +)?(?P<bus>\S{1,15})(?:"
    # As in a log: 123#DEADBEEF, 123#R for a remote request, and 123##1DEADBEEF for CAN FD.
    rf" (?P<log>{_ID})#"
    r"(?P<packed>R[0-9a-f]?|#[0-9a-f](?:[0-9a-f]{2}){0,64}|(?:[0-9a-f]{2}){0,8})"
    r"(?: (?P<log_direction>[RT]))?|"
    # As on the screen: 123   [4]  DE AD BE EF   '....'
    rf"(?: +(?P<direction>[RT]X)(?: [ A-Z-]){{2}})? +(?P<id>{_ID}) +\[ ?(?P<size>[0-9]{{1,2}})\]"
    r"(?: +(?P<remote>remote request)| +(?P<spaced>(?:[0-9a-f]{2} ?)+?)(?: +'.*')?)?"
    r") *",
    re.IGNORECASE,
)
_DIRECTIONS: dict[str, Direction] = {"T": "sent", "R": "received"}


def _candump(file: ForeignFile) -> Iterator[Chunk]:
    """Yield what ``candump`` and ``candump -L`` of can-utils 2020 print; a stream for each id."""
    remote = 0
    timed: bool | None = None
    for line in file.lines():
        if not (found := _CANDUMP.fullmatch(line.text)):
            file.reject(
                line, "a line of candump, '(0.000000) can0 123#DEADBEEF' or 'can0 123 [1] DE'"
            )
        time_ns = _can_time(found["time"])
        timed = found["time"] is not None if timed is None else timed
        if timed != (time_ns is not None):
            file.reject(line, "a time in parentheses, in all lines or in none")
        packed = found["packed"] or ""
        if found["remote"] or (packed[:1] in "Rr" and packed):
            remote += 1
            continue
        # A CAN FD frame has a digit of flags before its bytes.
        data = bytes.fromhex(packed[2:] if packed[:1] == "#" else packed or found["spaced"] or "")
        if found["size"] and int(found["size"]) != len(data):
            file.reject(line, f"{found['size']} bytes, as the line says")
        letter = (found["log_direction"] or found["direction"] or " ")[0].upper()
        stream = f"{found['bus']} {(found['log'] or found['id']).upper()}"
        if data:
            yield Chunk(data, _DIRECTIONS.get(letter, "unknown"), time_ns, stream)
    if remote:
        file.notes.append(f"left out {counted(remote, 'remote request')}, which have no data")


def _can_time(text: str | None) -> int | None:
    if text is None:
        return None
    if (seconds := seconds_ns(text.strip())) is not None:
        return seconds
    day, _, fraction = text.partition(".")
    start, part = day_time_ns(day, "%Y-%m-%d %H:%M:%S"), seconds_ns(f"0.{fraction}")
    return None if start is None or part is None else start + part


READERS = (
    Reader(
        "socat",
        "a socat dump",
        starts_with(
            rb"(?:[0-9/]{10} [0-9:]{8} socat\[.*\n)*"
            rb"[<>] [0-9/]{10} [0-9:.]+  length=[0-9]+ .*\n [0-9a-f]{2}(?:[ \r\n]|$)"
        ),
        _socat,
        remark=f"{LOCAL}; > is taken as sent",
    ),
    Reader(
        "pymycobot",
        "a log of pymycobot",
        re.compile(rb"_(?:write|read) ?:(?: *[0-9a-fA-F]{1,2}(?=[ \r\n]|$))").search,
        _pymycobot,
        remark=LOCAL,
    ),
    Reader(
        "candump",
        "a log of candump",
        starts_with(
            rb"(?:\([0-9 .:-]{3,32}\) +)?[a-z][a-z0-9_.-]{0,14}"
            rb"(?: %b#|(?: +[RT]X .{3})? +%b +\[[0-9 ]{1,2}\])" % (_ID.encode(), _ID.encode())
        ),
        _candump,
    ),
)
