"""Answers and acknowledgements in a frame that is wrong: LEN, id, footer, header, bytes missing."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.interface import Codec, Message
from cobotwire.table import Command, Table, TextReply
from mutation.device.broken import BrokenArm, Fault, Said
from mutation.device.cells import framed
from mutation.device.exchanges import distinct
from mutation.mutant import Mutant

# From the table and a whole right frame to what is sent.
Reframe = Callable[[Table, bytes], bytes]


class WrongFrame(Fault):
    """What one command is answered with is framed wrong."""

    def __init__(self, command: Command, reframe: Reframe) -> None:
        self._command = command
        self._reframe = reframe

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """The same answer in another frame."""
        wrong = asked.command is self._command and data
        return [Said(0.0, self._reframe(codec.table, data) if wrong else data)]


def wrong_frames(table: Table) -> Iterator[Mutant]:
    """Every answer and every acknowledgement, framed wrong in every way."""
    for command in distinct(table):
        ways = TEXTS if command.text is not None else FRAMES if command.reply else ()
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
    """LEN says another number; the bytes are the same."""

    def reframe(table: Table, data: bytes) -> bytes:
        at = table.frame.length_at
        return data[:at] + bytes([data[at] + step]) + data[at + 1 :]

    return reframe


def _id(pick: Callable[[Table, int], int]) -> Reframe:
    def reframe(table: Table, data: bytes) -> bytes:
        at = table.frame.overhead
        return framed(table.frame, pick(table, data[at]), _payload(table, data))

    return reframe


def _unused_id(table: Table, id: int) -> int:
    used = {command.id for command in table.commands}
    return next(other % 256 for other in range(id + 1, id + 257) if other % 256 not in used)


def _other_id(table: Table, id: int) -> int:
    """The id of the command after it in the table."""
    ids = list(dict.fromkeys(command.id for command in table.commands))
    return ids[(ids.index(id) + 1) % len(ids)]


def _payload(table: Table, data: bytes) -> bytes:
    frame = table.frame
    return data[frame.overhead + 1 : len(data) - frame.check_size]


def _resized(change: Callable[[bytes], bytes]) -> Reframe:
    """Other data, with the LEN that is right for it."""

    def reframe(table: Table, data: bytes) -> bytes:
        id = data[table.frame.overhead]
        return framed(table.frame, id, change(_payload(table, data)))

    return reframe


def _other_footer(table: Table, data: bytes) -> bytes:
    return data[:-1] + bytes([data[-1] ^ 0xFF])


FRAMES: tuple[tuple[str, str, Reframe], ...] = (
    ("LEN", "one too many in LEN", _length(1)),
    ("LEN", "one too few in LEN", _length(-1)),
    ("LEN", "a byte of data too many", _resized(lambda data: data + b"\0")),
    ("id", "an id that the edition lacks", _id(_unused_id)),
    ("id", "another command's id", _id(_other_id)),
    ("footer", "another footer", _other_footer),
    ("footer", "no footer", lambda _, data: data[:-1]),
    ("header", "half a header", lambda _, data: data[1:]),
    ("header", "another header", lambda _, data: bytes([data[0] ^ 1]) + data[1:]),
)


def _first_prefix_gone(table: Table, data: bytes) -> bytes:
    """The text without what stands in front of its first part."""
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
    ("text", "what stands in front of its first part is left out", _first_prefix_gone),
    ("text", "what stands in front of its last part is left out", _last_prefix_gone),
    ("text", "the text in a frame", _in_a_frame),
)
