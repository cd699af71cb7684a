"""Replies and acknowledgements in a wrong frame: LEN, id, footer, header, bytes missing."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.table import Command, Table, TextReply
from mutation.device.broken import BrokenArm, Fault, TimedBytes
from mutation.device.cells import checked, framed
from mutation.device.exchanges import distinct
from mutation.mutant import Mutant

# Takes the table and the bytes of a correct frame; returns the bytes to send.
Reframe = Callable[[Table, bytes], bytes]


class WrongFrame(Fault):
    """The reply to one command has a wrong frame."""

    def __init__(self, command: Command, reframe: Reframe) -> None:
        self._command = command
        self._reframe = reframe

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the same reply in another frame."""
        wrong = request.command is self._command and data
        return [TimedBytes(0.0, self._reframe(codec.table, data) if wrong else data)]


def wrong_frames(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each reply or acknowledgement and each kind of wrong frame."""
    for command in distinct(table):
        framed_ways = (*FRAMES, *_of_format(table))
        ways = TEXTS if command.text is not None else framed_ways if command.reply else ()
        for kind, text, reframe in ways:
            yield _mutant(table, command, kind, text, reframe)


def _mutant(table: Table, command: Command, kind: str, text: str, reframe: Reframe) -> Mutant:
    return Mutant(
        kind,
        command.name,
        "",
        text,
        lambda clock: BrokenArm(table, WrongFrame(command, reframe), clock),
    )


def _length(step: int) -> Reframe:
    """Change only LEN, and the check that covers it."""

    def reframe(table: Table, data: bytes) -> bytes:
        frame = table.frame
        return checked(frame, frame.with_length(data, frame.read_length(data) + step))

    return reframe


def _id(pick: Callable[[Table, int], int]) -> Reframe:
    def reframe(table: Table, data: bytes) -> bytes:
        frame = table.frame
        id = pick(table, frame.read_id(data))
        return framed(frame, id, frame.data(data), frame.address(data))

    return reframe


def _unused_id(table: Table, id: int) -> int:
    used = {command.id for command in table.commands}
    return next(other % 256 for other in range(id + 1, id + 257) if other % 256 not in used)


def _other_id(table: Table, id: int) -> int:
    """Return the id of the next command in the table."""
    ids = list(dict.fromkeys(command.id for command in table.commands))
    return ids[(ids.index(id) + 1) % len(ids)]


def _resized(change: Callable[[bytes], bytes]) -> Reframe:
    """Change the data, with a correct LEN."""

    def reframe(table: Table, data: bytes) -> bytes:
        frame = table.frame
        changed = change(frame.data(data))
        return framed(frame, frame.read_id(data), changed, frame.address(data))

    return reframe


def _other_footer(table: Table, data: bytes) -> bytes:
    return data[:-1] + bytes([data[-1] ^ 0xFF])


def _other_header(table: Table, data: bytes) -> bytes:
    return checked(table.frame, bytes([data[0] ^ 1]) + data[1:])


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


def _from_address(pick: Callable[[tuple[int, ...]], int]) -> Reframe:
    """Change only the address, and the check if it covers it."""

    def reframe(table: Table, data: bytes) -> bytes:
        frame, at = table.frame, table.frame.address_at
        assert at is not None, "only formats with addresses have this fault"
        return checked(frame, data[:at] + bytes([pick(frame.addresses)]) + data[at + 1 :])

    return reframe


def _unused_address(addresses: tuple[int, ...]) -> int:
    return next(other for other in range(256) if other not in addresses)


def _of_format(table: Table) -> Iterator[tuple[str, str, Reframe]]:
    """Yield the faults of frames with a check value, and of frames with an address."""
    check = table.frame.check
    if check is not None:
        yield "check", "over the data alone", _check_of_data
        if check.width > 1:
            yield "check", "its bytes swapped", _swapped_check
    if table.frame.addresses:
        yield "address", "an address that the edition lacks", _from_address(_unused_address)
        yield "address", "another part's address", _from_address(lambda addresses: addresses[-1])


FRAMES: tuple[tuple[str, str, Reframe], ...] = (
    ("LEN", "one too many in LEN", _length(1)),
    ("LEN", "one too few in LEN", _length(-1)),
    ("LEN", "a byte of data too many", _resized(lambda data: data + b"\0")),
    ("id", "an id that the edition lacks", _id(_unused_id)),
    ("id", "another command's id", _id(_other_id)),
    ("footer", "another footer", _other_footer),
    ("footer", "no footer", lambda _, data: data[:-1]),
    ("header", "half a header", lambda _, data: data[1:]),
    ("header", "another header", _other_header),
)


def _first_prefix_gone(table: Table, data: bytes) -> bytes:
    """Return the text without the prefix of its first part."""
    text = next(command.text for command in table.commands if command.text is not None)
    return data[len(_prefix(text, 0)) :]


def _last_prefix_gone(table: Table, data: bytes) -> bytes:
    text = next(command.text for command in table.commands if command.text is not None)
    return data.replace(_prefix(text, -1), b"")


def _prefix(text: TextReply, at: int) -> bytes:
    return text.prefixes[at].encode("ascii")


def _in_a_frame(table: Table, data: bytes) -> bytes:
    command = next(command for command in table.commands if command.text is not None)
    return framed(table.frame, command.id, data)


TEXTS: tuple[tuple[str, str, Reframe], ...] = (
    ("text", "without its first prefix", _first_prefix_gone),
    ("text", "without its last prefix", _last_prefix_gone),
    ("text", "the text in a frame", _in_a_frame),
)
