"""Draw legal messages of any table as raw values, whatever their types."""

from __future__ import annotations

from typing import NamedTuple

from hypothesis import strategies as st

from cobotwire.protocol.table import Command, Direction, Table
from strategies import CommandVariant, raw_rows, variants_of


class RawMessage(NamedTuple):
    """A message with its raw values, a row for each field, and its frame."""

    variant: CommandVariant
    rows: list[tuple[int, ...]]
    frame: bytes

    def __repr__(self) -> str:
        """Leave out the command and its variants, whose text is very long."""
        place = f"{self.command.name}, {self.direction}, {self.variant.number}"
        return f"RawMessage({place}, {self.rows}, {self.frame.hex(' ')})"

    @property
    def command(self) -> Command:
        """The command of the message."""
        return self.variant.command

    @property
    def direction(self) -> Direction:
        """The direction of the message."""
        return self.variant.direction


@st.composite
def raw_messages(draw: st.DrawFn, table: Table) -> RawMessage:
    """Draw a legal message of any variant, with any address."""
    # Draw an index: Hypothesis hashes the values it samples from, and these records are large.
    found = variants_of(table)
    variant = found[draw(st.integers(0, len(found) - 1))]
    rows = draw(raw_rows(variant.variant))
    address = draw(st.sampled_from(table.frame.addresses or (None,)))
    data = variant.variant.pack(rows)
    frame = table.frame.enclose(variant.command.id, data, address, variant.direction)
    return RawMessage(variant, rows, frame)
