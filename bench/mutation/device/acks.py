"""Frames that nobody asked for: an acknowledgement where none is due."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.codec.interface import Codec, Message
from cobotwire.table import Command, Table
from mutation.device.broken import BrokenArm, Fault, Said
from mutation.device.cells import framed
from mutation.device.exchanges import distinct
from mutation.mutant import Mutant

DONE = b"\x01"


class Acknowledged(Fault):
    """One command is acknowledged though the edition knows no acknowledgement of it."""

    def __init__(self, command: Command, data: bytes) -> None:
        self._command = command
        self._data = data

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """The acknowledgement, and behind it what is due."""
        if asked.command is not self._command:
            return [Said(0.0, data)]
        return [Said(0.0, framed(codec.table.frame, self._command.id, self._data) + data)]


def wrong_acks(table: Table) -> Iterator[Mutant]:
    """Every command without an acknowledgement."""
    for command in distinct(table):
        if not command.ack:
            yield _mutant(table, command, "one that says done", DONE)
        if not command.ack and not command.answers:
            yield _mutant(table, command, "an empty one", b"")


def _mutant(table: Table, command: Command, text: str, data: bytes) -> Mutant:
    return Mutant(
        "ack where none is due",
        command.name,
        "",
        text,
        lambda clock: BrokenArm(table, Acknowledged(command, data), clock),
    )
