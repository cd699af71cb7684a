"""Mutants of the device: an edition's simulated arm with one fault, made from the table."""

from __future__ import annotations

from cobotwire.protocol.table import Table
from mutation.device.acks import wrong_acks
from mutation.device.fields import wrong_fields
from mutation.device.framing import wrong_frames
from mutation.device.malformed import breaks_on_malformed
from mutation.device.memory import loses_state, stale_replies
from mutation.device.setters import wrong_setters
from mutation.device.timing import wrong_times
from mutation.mutant import Mutant

MAKERS = (
    *(wrong_fields, wrong_frames, wrong_times, wrong_acks, wrong_setters, breaks_on_malformed),
    *(loses_state, stale_replies),
)


def device_mutants(table: Table) -> list[Mutant]:
    """Return every mutant of an edition's device in a fixed order, with unique ids."""
    return [mutant for make in MAKERS for mutant in make(table)]
