"""A client sends only values that their fields allow."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.client.history import History, Received
from cobotwire.conformance.places import places
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.conformance.tally import Observation
from cobotwire.protocol.table import Field, Table

TABLE = "the edition's table"
RANGE = TestCase("value-range", "A number is within the range of its field.", TABLE)
LISTED = TestCase("value-listed", "A value of a closed list is one of the list.", TABLE)


def _values(history: History, now: Received) -> Iterator[Observation]:
    """Check a frame that is legal except for a value; a wrong scale often shows here."""
    if now.error is not None:
        field = _field_at(history.codec.table, now.data, now.error.offset)
        listed = field is not None and bool(field.choices)
        yield Observation(LISTED if listed else RANGE, str(now.error))
    elif now.is_frame:
        yield from (Observation(RANGE), Observation(LISTED))


def _field_at(table: Table, data: bytes, offset: int) -> Field | None:
    """Return the field at an offset of a frame."""
    frame = table.frame
    size = len(frame.data(data))
    for command in table.commands:
        for variant in command.request if command.id == frame.read_id(data) else ():
            for place in places(variant) if variant.size == size else ():
                if 0 <= offset - frame.data_at - place.start < place.number.width:
                    return place.field
    return None


VALUES = Group("values", (RANGE, LISTED), _values, subject="each legal frame")
