"""Answers that do not come, come after the deadline, or come twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.interface import Codec, Message
from cobotwire.table import Command, Table
from mutation.device.broken import BrokenArm, Fault, Said
from mutation.device.exchanges import distinct
from mutation.mutant import Mutant

# So many deadlines after the question a late answer comes; half a deadline after the end of it.
LATE = 1.5
# A second copy that does not follow at once follows so many seconds later.
AFTERWARDS = 0.02

Say = Callable[[Command, bytes], list[Said]]


class WrongTime(Fault):
    """One command is answered at the wrong time, or not once."""

    def __init__(self, command: Command, say: Say) -> None:
        self._command = command
        self._say = say

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """The right bytes at other times."""
        if asked.command is not self._command or not data:
            return [Said(0.0, data)]
        return self._say(self._command, data)


def wrong_times(table: Table) -> Iterator[Mutant]:
    """Every answer that is due; an acknowledgement may be late or missing, but not come twice."""
    for command in distinct(table):
        ways = WAYS if command.answers else TWICE if command.reply else ()
        for kind, text, say in ways:
            yield _mutant(table, command, kind, text, say)


def _mutant(table: Table, command: Command, kind: str, text: str, say: Say) -> Mutant:
    return Mutant(
        kind,
        command.name,
        "",
        text,
        lambda clock: BrokenArm(table, WrongTime(command, say), clock),
    )


def _late(command: Command, data: bytes) -> list[Said]:
    return [Said(LATE * command.deadline_ms / 1000, data)]


TWICE: tuple[tuple[str, str, Say], ...] = (
    ("double reply", "at once", lambda _, data: [Said(0.0, data + data)]),
    (
        "double reply",
        "the second a little later",
        lambda _, data: [Said(0.0, data), Said(AFTERWARDS, data)],
    ),
)
WAYS: tuple[tuple[str, str, Say], ...] = (
    ("no reply", "never", lambda *_: []),
    ("late reply", "after the deadline", _late),
    *TWICE,
)
