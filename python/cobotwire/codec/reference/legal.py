"""Which frames are legal in one direction: by command id, then by data size."""

from __future__ import annotations

from cobotwire.table import Command, Direction, Layout, Table

Form = tuple[Command, Layout]


class Forms:
    """The forms of an edition's messages in one direction, by id and size."""

    def __init__(self, table: Table, direction: Direction) -> None:
        self.table = table
        self.direction: Direction = direction
        self.by_id: dict[int, dict[int, list[Form]]] = {}
        for command in table.commands:
            for layout in command.layouts(direction):
                sizes = self.by_id.setdefault(command.id, {})
                # Calls may share an id and a size; they are tried in the order of the table.
                sizes.setdefault(layout.size, []).append((command, layout))
        self.lengths = {table.frame.length(size) for sizes in self.by_id.values() for size in sizes}

    def find(self, id: int, length: int) -> list[Form]:
        """The forms with that id and LEN; none, if the frame is not legal."""
        return self.by_id.get(id, {}).get(length - self.table.frame.length(0), [])
