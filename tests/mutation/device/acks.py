"""Devices that send acknowledgements that the edition does not define, or omit one of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.table import Command, Table
from mutation.device.broken import BrokenArm, Fault, TimedBytes
from mutation.device.cells import framed, replier
from mutation.device.exchanges import distinct
from mutation.mutant import Mutant

DONE = b"\x01"


class Acknowledged(Fault):
    """One command is acknowledged, although the edition defines no acknowledgement for it."""

    def __init__(self, command: Command, data: bytes) -> None:
        self._command = command
        self._data = data

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the wrong acknowledgement, followed by the correct reply."""
        if request.command is not self._command:
            return [TimedBytes(0.0, data)]
        table = codec.table
        address = replier(table, request.address)
        ack = framed(table.frame, self._command.id, self._data, address)
        return [TimedBytes(0.0, ack + data)]


class Unacknowledged(Fault):
    """One command is not acknowledged, although the device acknowledges the others."""

    def __init__(self, command: Command) -> None:
        self._command = command

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return nothing in place of the acknowledgement."""
        return [TimedBytes(0.0, b"" if request.command is self._command else data)]


def wrong_acks(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for every command without an acknowledgement, and for every one with it."""
    for command in distinct(table):
        if command.ack:
            yield _mutant(table, command, "it is missing", partial(Unacknowledged, command))
        if not command.ack:
            fault = partial(Acknowledged, command, DONE)
            yield _mutant(table, command, "it reports done", fault)
        if not command.ack and not command.requires_reply:
            yield _mutant(table, command, "it has no data", partial(Acknowledged, command, b""))


def _mutant(table: Table, command: Command, text: str, fault: Callable[[], Fault]) -> Mutant:
    return Mutant(
        "wrong ack", command.name, "", text, lambda clock: BrokenArm(table, fault(), clock)
    )
