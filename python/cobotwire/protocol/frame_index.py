"""Find the messages of one direction that can have a command id and a LEN."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cobotwire.protocol.table import Command, Direction, Table, Variant


class MessageVariant(NamedTuple):
    """One variant of a command's message in one direction."""

    command: Command
    direction: Direction
    variant_index: int

    @property
    def variant(self) -> Variant:
        """The variant itself, with its fields."""
        return self.command.variants(self.direction)[self.variant_index]


class FrameIndex:
    """The messages of an edition in one direction, found by command id and LEN.

    Attributes:
        lengths: every LEN that a frame of this direction can have.
    """

    def __init__(self, table: Table, direction: Direction) -> None:
        self.table = table
        self.direction: Direction = direction
        self._has_id = table.frame.has_id(direction)
        self._found: dict[tuple[int | None, int], list[MessageVariant]] = {}
        for command in table.commands:
            for index, variant in enumerate(command.variants(direction)):
                length = table.frame.length(variant.size, direction)
                key = self._key(command.id, length)
                # Commands may share an id and a LEN. They are tried in the order of the table.
                self._found.setdefault(key, []).append(MessageVariant(command, direction, index))
        self._ids = {id for id, _ in self._found}
        self.lengths = {length for _, length in self._found}

    def find(self, id: int, length: int) -> list[MessageVariant]:
        """Return the messages with that command id and LEN; an empty list if there are none.

        If messages of this direction carry no id, ``id`` does not matter.
        """
        return self._found.get(self._key(id, length), [])

    def has(self, id: int) -> bool:
        """Return whether any message of this direction has that command id."""
        return (id if self._has_id else None) in self._ids

    def _key(self, id: int, length: int) -> tuple[int | None, int]:
        return (id if self._has_id else None), length


def longest_frame(table: Table, directions: Iterable[Direction] = ("request", "reply")) -> int:
    """Return the size of the longest frame of these directions; 0 if they have no messages."""
    lengths = [length for each in directions for length in FrameIndex(table, each).lengths]
    return table.frame.overhead + max(lengths) if lengths else 0
