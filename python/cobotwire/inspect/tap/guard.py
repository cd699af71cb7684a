"""Decide which bytes of a program may reach an arm that must not move."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command


class Decision(NamedTuple):
    """Bytes of the program, and whether they may be forwarded."""

    data: bytes
    passes: bool


class Guard:
    """Passes whole requests that only read, or that stop the arm; holds back all other bytes.

    If a request can be several commands with the same id, each of them must only read, or stop the
    arm. Bytes that are not a request of the edition are held back, because the arm may parse them
    differently.
    """

    def __init__(self, codec: Codec) -> None:
        self._framer = codec.framer("request")
        self._by_id: dict[int, list[Command]] = {}
        for command in codec.table.commands:
            self._by_id.setdefault(command.id, []).append(command)

    @property
    def pending(self) -> int:
        """The number of bytes of an incomplete request."""
        return self._framer.pending

    def feed(self, data: bytes) -> list[Decision]:
        """Take bytes; return what is decided, in the order of the stream."""
        return list(map(self._decision, self._framer.feed(data)))

    def flush(self) -> list[Decision]:
        """Give up an incomplete request."""
        return list(map(self._decision, self._framer.flush()))

    def _decision(self, event: Event) -> Decision:
        return Decision(event.data, isinstance(event, Frame) and self._is_harmless(event))

    def _is_harmless(self, frame: Frame) -> bool:
        possible = [each for each in self._by_id.get(frame.command, ()) if _can_be(frame, each)]
        return bool(possible) and all(map(is_harmless, possible))


def is_harmless(command: Command) -> bool:
    """Return whether a request only reads, or stops the arm."""
    return command.safety == "query" or command.is_stop


def _can_be(frame: Frame, command: Command) -> bool:
    try:
        frame.decode("request", of=command.name)
    except ProtocolError:
        return False
    return True
