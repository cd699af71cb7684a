"""Rules for values: what a field does not allow must not be sent."""

from __future__ import annotations

from cobotwire.conformance.client.past import Heard, Past
from cobotwire.conformance.client.rules.rule import Judgement, rule
from cobotwire.session.device import Asked, Malformed
from cobotwire.table import Field, Table


@rule("value-range", "a number is within the range of its field", "the edition's table")
def value_range(past: Past, now: Heard) -> Judgement:
    """A frame that is legal but for a number beyond its bounds; a wrong scale often shows so."""
    return _refused(past, now, closed=False)


@rule("value-listed", "a value of a closed list is one of the list", "the edition's table")
def value_listed(past: Past, now: Heard) -> Judgement:
    """A frame that is legal but for a number that is none of those which a field allows."""
    return _refused(past, now, closed=True)


def _refused(past: Past, now: Heard, closed: bool) -> Judgement:
    if isinstance(now.event, Asked):
        return ""
    if not isinstance(now.event, Malformed):
        return None
    error = now.event.error
    field = _field_at(past.codec.table, now.data, error.offset)
    listed = field is not None and bool(field.choices)
    return str(error) if listed == closed else None


def _field_at(table: Table, data: bytes, offset: int) -> Field | None:
    """The field that stands at a place of a frame."""
    frame = table.frame
    size = len(data) - frame.overhead - 1 - frame.check_size
    for command in table.commands:
        for layout in command.request if command.id == data[frame.overhead] else ():
            at = frame.overhead + 1
            for field in layout.fields if layout.size == size else ():
                if at <= offset < at + field.size:
                    return field
                at += field.size
    return None
