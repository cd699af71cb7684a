"""Which frames are legal in one direction: by command id, then by data size."""

from __future__ import annotations

from cobotwire.table import Command, Direction, Layout, Table


class Forms:
    """The forms of an edition's messages in one direction, by id and size."""

    def __init__(self, table: Table, direction: Direction) -> None:
        self.table = table
        self.by_id: dict[int, dict[int, tuple[Command, Layout]]] = {}
        for command in table.commands:
            for layout in command.layouts(direction):
                sizes = self.by_id.setdefault(command.id, {})
                # Calls that share an id and a size read alike on the wire: the first one names it.
                sizes.setdefault(layout.size, (command, layout))
        self.lengths = {table.frame.length(size) for sizes in self.by_id.values() for size in sizes}

    def find(self, id: int, length: int) -> tuple[Command, Layout] | None:
        """The form with that id and LEN, if there is one."""
        return self.by_id.get(id, {}).get(length - self.table.frame.length(0))
