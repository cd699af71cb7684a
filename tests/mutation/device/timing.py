"""Replies that are missing, that arrive after the deadline, or that arrive twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.table import Command, Table
from mutation.device.broken import BrokenArm, Fault, TimedBytes
from mutation.device.exchanges import distinct
from mutation.mutant import Mutant

# A late reply arrives this many deadlines after the request.
LATE = 1.5
# A delayed second copy arrives this many seconds after the first.
AFTERWARDS = 0.02

Send = Callable[[Command, bytes], list[TimedBytes]]


class WrongTime(Fault):
    """One command gets its reply at the wrong time, twice, or not at all."""

    def __init__(self, command: Command, send: Send) -> None:
        self._command = command
        self._send = send

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the correct bytes at other times."""
        if request.command is not self._command or not data:
            return [TimedBytes(0.0, data)]
        return self._send(self._command, data)


def wrong_times(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each reply and wrong time; for acknowledgements, only with copies."""
    for command in distinct(table):
        ways = WAYS if command.requires_reply else TWICE if command.reply else ()
        for kind, text, send in ways:
            yield _mutant(table, command, kind, text, send)


def _mutant(table: Table, command: Command, kind: str, text: str, send: Send) -> Mutant:
    return Mutant(
        kind,
        command.name,
        "",
        text,
        lambda clock: BrokenArm(table, WrongTime(command, send), clock),
    )


def _late(command: Command, data: bytes) -> list[TimedBytes]:
    return [TimedBytes(LATE * command.deadline_ms / 1000, data)]


TWICE: tuple[tuple[str, str, Send], ...] = (
    ("double reply", "at once", lambda _, data: [TimedBytes(0.0, data + data)]),
    (
        "double reply",
        "the second a little later",
        lambda _, data: [TimedBytes(0.0, data), TimedBytes(AFTERWARDS, data)],
    ),
)
WAYS: tuple[tuple[str, str, Send], ...] = (
    ("no reply", "never", lambda *_: []),
    ("late reply", "after the deadline", _late),
    *TWICE,
)
