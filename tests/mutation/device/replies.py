"""Replies and acknowledgements in wrong frames, at wrong times, missing, superfluous or stale."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from cobotwire.codec.interface import DecodedMessage
from cobotwire.protocol.table import Command, Table
from mutation.device.broken import Change, Fault, Mutant, TimedBytes, mutant_of, wrong_reply
from mutation.device.cells import (
    Edit,
    checked,
    framed,
    replier,
    with_address,
    with_length,
)
from mutation.device.exchanges import distinct

# A late reply arrives this many deadlines after the request.
LATE = 1.5
# A delayed second copy arrives this many seconds after the first.
AFTERWARDS = 0.02


def wrong_frames(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each reply or acknowledgement and each kind of wrong frame."""
    framed_ways = (*FRAMES, *_of_format(table))
    for command in distinct(table):
        ways = TEXTS if command.text is not None else framed_ways if command.reply else ()
        for kind, text, edit in ways:
            yield mutant_of(kind, text, command, partial(_edited, edit))


def _edited(edit: Edit, table: Table, request: DecodedMessage, data: bytes) -> bytes:
    return edit(table, data)


def _id(pick: Callable[[Table, int], int]) -> Edit:
    return lambda table, data: _rebuilt(table, data, id=pick(table, table.frame.read_id(data)))


def _rebuilt(table: Table, data: bytes, id: int | None = None, more: bytes = b"") -> bytes:
    """Return a frame with another id, or with more data and a correct LEN."""
    frame = table.frame
    id = frame.read_id(data) if id is None else id
    return framed(frame, id, frame.data(data) + more, frame.address(data))


def _unused_id(table: Table, id: int) -> int:
    used = {command.id for command in table.commands}
    return next(other % 256 for other in range(id + 1, id + 257) if other % 256 not in used)


def _other_id(table: Table, id: int) -> int:
    """Return the id of the next command in the table; of a text, the first one."""
    ids = list(dict.fromkeys(command.id for command in table.commands))
    return ids[(ids.index(id) + 1) % len(ids) if id in ids else 0]


def _swapped_check(table: Table, data: bytes) -> bytes:
    """Return the frame with the bytes of its check in the opposite order."""
    end = len(data) - table.frame.check_size
    tail = len(data) - len(table.frame.footer)
    return data[:end] + data[end:tail][::-1] + data[tail:]


def _check_of_data(table: Table, data: bytes) -> bytes:
    """Return the frame with a check that covers only the data bytes."""
    frame = table.frame
    assert frame.check is not None, "only formats with a check have this fault"
    end = len(data) - frame.check_size
    return data[:end] + frame.check.of(frame.data(data)) + frame.footer


def _of_format(table: Table) -> Iterator[tuple[str, str, Edit]]:
    """Yield the faults of frames with a check value, and of frames with an address."""
    check, addresses = table.frame.check, table.frame.addresses
    if check is not None:
        yield "check", "over the data alone", _check_of_data
        if check.width > 1:
            yield "check", "its bytes swapped", _swapped_check
    if addresses:
        unused = next(other for other in range(256) if other not in addresses)
        yield "address", "an address that the edition lacks", with_address(unused)
        yield "address", "another part's address", with_address(addresses[-1])


FRAMES: tuple[tuple[str, str, Edit], ...] = (
    ("LEN", "one too many in LEN", with_length(1)),
    ("LEN", "one too few in LEN", with_length(-1)),
    ("LEN", "a byte of data too many", lambda table, data: _rebuilt(table, data, more=b"\0")),
    ("id", "an id that the edition lacks", _id(_unused_id)),
    ("id", "another command's id", _id(_other_id)),
    ("footer", "another footer", lambda _, data: data[:-1] + bytes([data[-1] ^ 0xFF])),
    ("footer", "no footer", lambda _, data: data[:-1]),
    ("header", "half a header", lambda _, data: data[1:]),
    (
        "header",
        "another header",
        lambda table, data: checked(table.frame, bytes([data[0] ^ 1]) + data[1:]),
    ),
)


def _speaking(table: Table) -> Command:
    """Return the command that is replied to with a text."""
    return next(command for command in table.commands if command.text is not None)


def _prefix(table: Table, at: int) -> bytes:
    text = _speaking(table).text
    assert text is not None, "the command has a text"
    return text.prefixes[at].encode("ascii")


TEXTS: tuple[tuple[str, str, Edit], ...] = (
    ("text", "without its first prefix", lambda table, data: data[len(_prefix(table, 0)) :]),
    ("text", "without its last prefix", lambda table, data: data.replace(_prefix(table, -1), b"")),
    (
        "text",
        "the text in a frame",
        lambda table, data: framed(table.frame, _speaking(table).id, data),
    ),
)


def wrong_times(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each reply and wrong time; for acknowledgements, only with copies."""
    for command in distinct(table):
        ways = TIMES if command.requires_reply else TWICE if command.reply else ()
        for kind, text, change in ways:
            yield mutant_of(kind, text, command, change)


def _late(table: Table, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
    return [TimedBytes(LATE * request.command.deadline_ms / 1000, data)]


def _twice(table: Table, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
    return [TimedBytes(0.0, data), TimedBytes(AFTERWARDS, data)]


TWICE: tuple[tuple[str, str, Change], ...] = (
    ("double reply", "at once", lambda table, request, data: data + data),
    ("double reply", "the second a little later", _twice),
)
TIMES: tuple[tuple[str, str, Change], ...] = (
    ("no reply", "never", lambda *_: b""),
    ("late reply", "after the deadline", _late),
    *TWICE,
)


def wrong_acks(table: Table) -> Iterator[Mutant]:
    """Yield mutants that omit the acknowledgement of a command, or send one that does not exist."""
    for command in distinct(table):
        if command.ack:
            yield mutant_of("wrong ack", "it is missing", command, lambda *_: b"")
        if not command.ack:
            yield _acknowledged(command, "it reports done", b"\x01")
        if not command.ack and not command.requires_reply:
            yield _acknowledged(command, "it has no data", b"")


def _acknowledged(command: Command, text: str, body: bytes) -> Mutant:
    """Return a mutant that acknowledges a command, although the edition defines no such frame."""

    def change(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        return framed(table.frame, command.id, body, replier(table, request.address)) + data

    fault = partial(wrong_reply, command, change, also_silence=True)
    return Mutant("wrong ack", text, fault, command.name)


def stale_replies(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each query: it replies as it replied to the previous one."""
    for command in distinct(table):
        if command.safety == "query" and command.requires_reply:
            fault = partial(_stale, command)
            yield Mutant("stale reply", "that to the query before", fault, command.name)


def _stale(command: Command) -> Fault:
    """Return a fault that keeps the last reply to each address; the first reply is right."""
    before: dict[int | None, bytes] = {}

    def change(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        sent = before.get(request.address) or data
        before[request.address] = data
        return sent

    return wrong_reply(command, change, also_silence=True)
