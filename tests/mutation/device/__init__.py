"""Mutants of the device: an edition's simulated arm with one fault, made from the table."""

from __future__ import annotations

from cobotwire.protocol.table import Table
from mutation.device.broken import Mutant
from mutation.device.fields import wrong_fields
from mutation.device.replies import stale_replies, wrong_acks, wrong_frames, wrong_times
from mutation.device.requests import breaks_on_malformed, loses_state, wrong_setters

MAKERS = (
    *(wrong_fields, wrong_frames, wrong_times, wrong_acks, wrong_setters, breaks_on_malformed),
    *(loses_state, stale_replies),
)


def device_mutants(table: Table) -> list[Mutant]:
    """Return every mutant of an edition's device in a fixed order, with unique ids."""
    return [mutant for make in MAKERS for mutant in make(table)]
